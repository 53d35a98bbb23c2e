// Putting photons into the order in which they are traced: worth it only as long as it costs less than it saves.
#include "techniques/reference/photon_order.h"

#include <benchmark/benchmark.h>

#include "support/inputs.h"

namespace nephroid::bench {
namespace {

PhotonOrder makeOrder() {
  Bounds targets;
  targets.add(vec3(-1.0F));
  targets.add(vec3(1.0F));
  return PhotonOrder(targets);
}

void computeKeys(benchmark::State& state) {
  const PhotonOrder order = makeOrder();
  Cycle<vec2> places(makeSquarePoints());
  for (auto _ : state) {
    const vec2 place = 2.0F * places.next() - 1.0F;
    std::uint32_t key = order.keyOf(vec3(place.x, 5.0F, place.y), vec3(0, -1, 0));
    benchmark::DoNotOptimize(key);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(computeKeys)->Name("PhotonOrder/keyOf");

void sortKeys(benchmark::State& state) {
  const PhotonOrder order = makeOrder();
  std::vector<std::uint32_t> keys;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(state.range(0)); ++i) {
    const vec2 place = 2.0F * Sampler(5, 1, i).next2D() - 1.0F;
    keys.push_back(order.keyOf(vec3(place.x, 5.0F, place.y), vec3(0, -1, 0)));
  }
  for (auto _ : state) {
    auto sorted = PhotonOrder::sort(keys);
    benchmark::DoNotOptimize(sorted);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(sortKeys)->Name("PhotonOrder/sort")->Arg(1 << 12)->Arg(1 << 16)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace nephroid::bench
