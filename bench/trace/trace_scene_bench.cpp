// Rays against the ball of 131 thousand triangles.
#include "trace/trace_scene.h"

#include <benchmark/benchmark.h>

#include "support/inputs.h"
#include "support/scenes.h"

namespace nephroid::bench {
namespace {

/// The ball, built once for all benchmarks.
const TraceScene& getBall() {
  static const SceneData data = makeBall();
  static const TraceScene scene(data);
  return scene;
}

/// Parallel rays that go down onto the ball row by row, as a camera's do; about one in five misses.
std::vector<Ray> makeCoherentRays() {
  std::vector<Ray> rays;
  constexpr std::size_t kRow = 64;
  for (std::size_t i = 0; i < kInputCount; ++i) {
    const vec2 place = 2.0F * vec2(i % kRow, i / kRow) / static_cast<float>(kRow) - 1.0F;
    rays.push_back({vec3(place.x, 3.0F, place.y), vec3(0, -1, 0)});
  }
  return rays;
}

/// Rays from everywhere on a larger sphere to anywhere near the ball, as photons are after an event.
std::vector<Ray> makeScatteredRays() {
  return makeInputs([](Sampler& sampler) {
    const vec3 origin = 3.0F * sampleUniformSphere(sampler.next2D());
    const vec3 target = sampleUniformSphere(sampler.next2D());
    return Ray{origin, normalize(target - origin)};
  });
}

std::vector<Ray> makeRays(const benchmark::State& state) {
  return state.range(0) != 0 ? makeCoherentRays() : makeScatteredRays();
}

void buildScene(benchmark::State& state) {
  const SceneData data = makeBall();
  for (auto _ : state) {
    TraceScene scene(data);
    benchmark::DoNotOptimize(scene);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(data.triangleCount()));
}
BENCHMARK(buildScene)->Name("TraceScene/build")->Unit(benchmark::kMillisecond)->UseRealTime();

void intersectRays(benchmark::State& state) {
  const TraceScene& scene = getBall();
  Cycle<Ray> rays(makeRays(state));
  for (auto _ : state) {
    RayHit hit;
    bool met = scene.intersect(rays.next(), hit, state.range(0) != 0);
    benchmark::DoNotOptimize(met);
    benchmark::DoNotOptimize(hit);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(intersectRays)->Name("TraceScene/intersect/coherent")->Arg(0)->Arg(1);

void intersectPackets(benchmark::State& state) {
  const TraceScene& scene = getBall();
  const std::vector<Ray> rays = makeRays(state);
  std::size_t first = 0;
  for (auto _ : state) {
    std::array<const Ray*, TraceScene::kPacketSize> packet{};
    for (std::size_t i = 0; i < packet.size(); ++i) packet[i] = &rays[first + i];
    std::array<RayHit, TraceScene::kPacketSize> hits;
    scene.intersectPacket(packet, hits.data());
    benchmark::DoNotOptimize(hits);
    first = (first + packet.size()) % rays.size();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(TraceScene::kPacketSize));
}
BENCHMARK(intersectPackets)->Name("TraceScene/intersectPacket/coherent")->Arg(0)->Arg(1);

void testOcclusion(benchmark::State& state) {
  const TraceScene& scene = getBall();
  Cycle<Ray> rays(makeRays(state));
  for (auto _ : state) {
    bool occluded = scene.occluded(rays.next());
    benchmark::DoNotOptimize(occluded);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(testOcclusion)->Name("TraceScene/occluded/coherent")->Arg(0)->Arg(1);

void testPacketOcclusion(benchmark::State& state) {
  const TraceScene& scene = getBall();
  const std::vector<Ray> rays = makeRays(state);
  std::size_t first = 0;
  for (auto _ : state) {
    std::uint32_t occluded = scene.occludedPacket(std::span(rays).subspan(first, TraceScene::kPacketSize));
    benchmark::DoNotOptimize(occluded);
    first = (first + TraceScene::kPacketSize) % rays.size();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(TraceScene::kPacketSize));
}
BENCHMARK(testPacketOcclusion)->Name("TraceScene/occludedPacket/coherent")->Arg(0)->Arg(1);

void describeHits(benchmark::State& state) {
  const TraceScene& scene = getBall();
  struct Met {
    Ray ray;
    RayHit hit;
  };
  std::vector<Met> met;
  for (const Ray& ray : makeRays(state)) {
    RayHit hit;
    if (scene.intersect(ray, hit)) met.push_back({ray, hit});
  }
  std::size_t next = 0;
  for (auto _ : state) {
    SurfacePoint point = scene.surfaceAt(met[next].ray, met[next].hit);
    benchmark::DoNotOptimize(point);
    next = next + 1 < met.size() ? next + 1 : 0;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(describeHits)->Name("TraceScene/surfaceAt/coherent")->Arg(0)->Arg(1);

}  // namespace
}  // namespace nephroid::bench
