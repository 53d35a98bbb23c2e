// Light sampled towards a point, as at every event of a path from the eye.
#include "trace/light_set.h"

#include <benchmark/benchmark.h>

#include "support/inputs.h"
#include "support/scenes.h"

namespace nephroid::bench {
namespace {

void sampleLight(benchmark::State& state, LightChoice choice) {
  const SceneData data = makeLitBall(choice, 64);
  const TraceScene scene(data);
  const MaterialTable materials(scene);
  const LightSet lights(scene, materials);
  Cycle<vec2> points(makeSquarePoints());
  const vec3 position(0.2F, -1.5F, 0.4F);
  for (auto _ : state) {
    auto sample = lights.sample(position, 0.5F, points.next());
    benchmark::DoNotOptimize(sample);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(sampleLight, sun, LightChoice::kSun)->Name("LightSet/sample/sun");
BENCHMARK_CAPTURE(sampleLight, point, LightChoice::kPoint)->Name("LightSet/sample/point");
BENCHMARK_CAPTURE(sampleLight, spot, LightChoice::kSpot)->Name("LightSet/sample/spot");
BENCHMARK_CAPTURE(sampleLight, mesh, LightChoice::kMesh)->Name("LightSet/sample/mesh");
BENCHMARK_CAPTURE(sampleLight, environment, LightChoice::kEnvironment)->Name("LightSet/sample/environment");

}  // namespace
}  // namespace nephroid::bench
