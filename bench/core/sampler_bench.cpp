// What a random number costs.
#include "core/sampling/sampler.h"

#include <benchmark/benchmark.h>

#include "core/sampling/halton.h"
#include "core/spectrum.h"
#include "support/inputs.h"

namespace nephroid::bench {
namespace {

/// Numbers of one sampler, about as many as a photon of three events uses: making the sampler is a part of the cost.
constexpr int kNumbers = 16;

void drawNumbers(benchmark::State& state) {
  std::uint32_t index = 0;
  for (auto _ : state) {
    Sampler sampler(1, 2, index++);
    float sum = 0.0F;
    for (int i = 0; i < kNumbers; ++i) sum += sampler.next1D();
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * kNumbers);
}
BENCHMARK(drawNumbers)->Name("Sampler/next1D");

void drawPairs(benchmark::State& state) {
  std::uint32_t index = 0;
  for (auto _ : state) {
    Sampler sampler(1, 2, index++);
    vec2 sum(0.0F);
    for (int i = 0; i < kNumbers / 2; ++i) sum += sampler.next2D();
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * kNumbers / 2);
}
BENCHMARK(drawPairs)->Name("Sampler/next2D");

void computeHalton(benchmark::State& state) {
  const auto dimension = static_cast<int>(state.range(0));
  std::uint32_t index = 0;
  for (auto _ : state) {
    float x = halton(index++, dimension, 5);
    benchmark::DoNotOptimize(x);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(computeHalton)->Name("Halton/scrambled/dimension")->Arg(0)->Arg(5)->Arg(20);

template <class Warp>
void warpSquare(benchmark::State& state, const Warp& warp) {
  Cycle<vec2> points(makeSquarePoints());
  for (auto _ : state) {
    auto warped = warp(points.next());
    benchmark::DoNotOptimize(warped);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(warpSquare, disc, [](vec2 u) { return sampleConcentricDisc(u); })->Name("Warp/concentric_disc");
BENCHMARK_CAPTURE(warpSquare, cosine, [](vec2 u) { return sampleCosineHemisphere(u); })->Name("Warp/cosine_hemisphere");
BENCHMARK_CAPTURE(warpSquare, cone, [](vec2 u) { return sampleUniformCone(u, 1e-5F); })->Name("Warp/uniform_cone");
BENCHMARK_CAPTURE(warpSquare, triangle, [](vec2 u) { return sampleUniformTriangle(u); })->Name("Warp/uniform_triangle");

void chooseWavelength(benchmark::State& state) {
  Cycle<vec2> points(makeSquarePoints());
  for (auto _ : state) {
    Band band = sampleWavelength(points.next().x);
    benchmark::DoNotOptimize(band);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(chooseWavelength)->Name("Spectrum/sampleWavelength");

}  // namespace
}  // namespace nephroid::bench
