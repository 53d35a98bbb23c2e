// Photons gathered by place.
#include "trace/photon_grid.h"

#include <benchmark/benchmark.h>

#include "support/inputs.h"

namespace nephroid::bench {
namespace {

/// On a floor of 4 m².
std::vector<GridPhoton> makePhotons(std::int64_t count) {
  std::vector<GridPhoton> photons;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
    const vec2 place = 2.0F * Sampler(4, 1, i).next2D() - 1.0F;
    photons.push_back({vec3(place.x, 0.0F, place.y), vec3(0, -1, 0), vec3(1.0F)});
  }
  return photons;
}

/// How many photons a search finds, about.
constexpr float kExpected = 20.0F;

void buildGrid(benchmark::State& state) {
  const std::vector<GridPhoton> photons = makePhotons(state.range(0));
  const float radius = chooseGatherRadius(photons, kExpected);
  for (auto _ : state) {
    PhotonGrid grid(photons, radius);
    benchmark::DoNotOptimize(grid);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(buildGrid)->Name("PhotonGrid/build")->Arg(1 << 14)->Arg(1 << 18)->Unit(benchmark::kMicrosecond);

void queryGrid(benchmark::State& state) {
  const std::vector<GridPhoton> photons = makePhotons(state.range(0));
  const PhotonGrid grid(photons, chooseGatherRadius(photons, kExpected));
  Cycle<vec2> points(makeSquarePoints());
  for (auto _ : state) {
    const vec2 place = 2.0F * points.next() - 1.0F;
    vec3 flux(0.0F);
    grid.visitNear(vec3(place.x, 0.0F, place.y), [&](const GridPhoton& photon) { flux += photon.flux; });
    benchmark::DoNotOptimize(flux);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(queryGrid)->Name("PhotonGrid/visitNear")->Arg(1 << 14)->Arg(1 << 18);

}  // namespace
}  // namespace nephroid::bench
