// Photons as they leave each kind of light, aimed at the ball.
#include "trace/emission.h"

#include <benchmark/benchmark.h>

#include "support/scenes.h"

namespace nephroid::bench {
namespace {

/// Coarser than the ball that rays are traced against: what is prepared once per light grows with the triangles, what a
/// photon costs does not.
constexpr int kTargetSegments = 128;

/// The ball under one light, ready to emit.
struct Aim {
  explicit Aim(LightChoice choice)
      : data(makeLitBall(choice, kTargetSegments)),
        scene(data),
        materials(scene),
        lights(scene, materials),
        targets(scene, makeTargetFlags()) {}
  std::vector<bool> makeTargetFlags() const {
    std::vector<bool> flags;
    for (const Instance& instance : data.instances) flags.push_back(data.materialOf(instance).transmits());
    return flags;
  }
  std::vector<std::unique_ptr<Emitter>> makeAll() const { return makeEmitters(scene, materials, lights, targets); }

  SceneData data;
  TraceScene scene;
  MaterialTable materials;
  LightSet lights;
  EmissionTargets targets;
};

/// The photon's numbers included.
void emitPhotons(benchmark::State& state, LightChoice choice) {
  const Aim aim(choice);
  const auto emitters = aim.makeAll();
  std::uint32_t index = 0;
  for (auto _ : state) {
    Sampler sampler(1, 1, index++);
    EmittedPhoton photon = emitters.at(0)->emit(sampler);
    benchmark::DoNotOptimize(photon);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(emitPhotons, sun, LightChoice::kSun)->Name("Emission/emit/sun");
BENCHMARK_CAPTURE(emitPhotons, point, LightChoice::kPoint)->Name("Emission/emit/point");
BENCHMARK_CAPTURE(emitPhotons, spot, LightChoice::kSpot)->Name("Emission/emit/spot");
BENCHMARK_CAPTURE(emitPhotons, mesh, LightChoice::kMesh)->Name("Emission/emit/mesh");
BENCHMARK_CAPTURE(emitPhotons, environment, LightChoice::kEnvironment)->Name("Emission/emit/environment");

/// Finding out where the targets are, once per light and render.
void prepareEmitter(benchmark::State& state, LightChoice choice) {
  const Aim aim(choice);
  for (auto _ : state) {
    auto emitters = aim.makeAll();
    benchmark::DoNotOptimize(emitters);
  }
}
BENCHMARK_CAPTURE(prepareEmitter, sun, LightChoice::kSun)
    ->Name("Emission/prepare/sun")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(prepareEmitter, point, LightChoice::kPoint)
    ->Name("Emission/prepare/point")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(prepareEmitter, environment, LightChoice::kEnvironment)
    ->Name("Emission/prepare/environment")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace nephroid::bench
