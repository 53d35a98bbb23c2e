// Sampling from tables, and making them.
#include "core/sampling/distribution.h"

#include <benchmark/benchmark.h>

#include "support/inputs.h"

namespace nephroid::bench {
namespace {

std::vector<float> makeWeights(std::size_t count) {
  std::vector<float> weights;
  for (std::uint32_t i = 0; i < count; ++i) weights.push_back(Sampler(3, 1, i).next1D());
  return weights;
}

/// From a scene's lights to a light of as many triangles as the ball.
void forTableSizes(benchmark::internal::Benchmark* benchmark) { benchmark->Arg(16)->Arg(1 << 10)->Arg(1 << 17); }

void sampleTable(benchmark::State& state) {
  const Distribution1D distribution(makeWeights(static_cast<std::size_t>(state.range(0))));
  Cycle<vec2> points(makeSquarePoints());
  for (auto _ : state) {
    auto sample = distribution.sample(points.next().x);
    benchmark::DoNotOptimize(sample);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(sampleTable)->Name("Distribution1D/sample")->Apply(forTableSizes);

void buildTable(benchmark::State& state) {
  const std::vector<float> weights = makeWeights(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    Distribution1D distribution(weights);
    benchmark::DoNotOptimize(distribution);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(buildTable)->Name("Distribution1D/build")->Apply(forTableSizes);

/// Width of a latitude–longitude map, half as high.
void forMapSizes(benchmark::internal::Benchmark* benchmark) { benchmark->Arg(64)->Arg(1024); }

void sampleMap(benchmark::State& state) {
  const auto width = static_cast<std::size_t>(state.range(0));
  const Distribution2D distribution = makeLatLongDistribution(width, width / 2, makeWeights(width * width / 2));
  Cycle<vec2> points(makeSquarePoints());
  for (auto _ : state) {
    auto sample = distribution.sample(points.next());
    benchmark::DoNotOptimize(sample);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(sampleMap)->Name("Distribution2D/sample")->Apply(forMapSizes);

void evaluateMap(benchmark::State& state) {
  const auto width = static_cast<std::size_t>(state.range(0));
  const Distribution2D distribution = makeLatLongDistribution(width, width / 2, makeWeights(width * width / 2));
  Cycle<vec2> points(makeSquarePoints());
  for (auto _ : state) {
    float pdf = distribution.pdf(points.next());
    benchmark::DoNotOptimize(pdf);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(evaluateMap)->Name("Distribution2D/pdf")->Apply(forMapSizes);

void buildMap(benchmark::State& state) {
  const auto width = static_cast<std::size_t>(state.range(0));
  const std::vector<float> luminance = makeWeights(width * width / 2);
  for (auto _ : state) {
    Distribution2D distribution = makeLatLongDistribution(width, width / 2, luminance);
    benchmark::DoNotOptimize(distribution);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0) * state.range(0) / 2);
}
BENCHMARK(buildMap)->Name("Distribution2D/build")->Apply(forMapSizes);

}  // namespace
}  // namespace nephroid::bench
