// One scattering event: the Bsdf at a hit, a direction from it, its value for another.
#include "trace/bsdf.h"

#include <benchmark/benchmark.h>

#include "scene/classify.h"
#include "support/inputs.h"
#include "support/scenes.h"

namespace nephroid::bench {
namespace {

Material makeVarnish() {
  Material material = test::makeDiffuse(vec3(0.7F));
  material.roughness = 0.0F;
  return material;
}

/// A surface of one material as a path finds it: resolved by the scene's table.
struct Surface {
  explicit Surface(const Material& m) : data(makeFloor(m)), scene(data), table(scene) {
    const Ray ray{vec3(0.3F, 2.0F, 0.7F), vec3(0, -1, 0)};
    RayHit hit;
    scene.intersect(ray, hit);
    point = scene.surfaceAt(ray, hit);
    frame = Frame::fromZ(point.normal_shading);
  }
  static SceneData makeFloor(const Material& material) {
    SceneData made;
    test::addObject(made, test::makeFloor(4.0), material);
    return made;
  }
  Bsdf makeBsdf(vec3 wo) const {
    return Bsdf(table.at(point, scratch), point, frame.toWorld(wo), 1.0F, 1.5F, kDefaultSpecularAlpha);
  }

  SceneData data;
  TraceScene scene;
  MaterialTable table;
  SurfacePoint point{};
  Frame frame;
  mutable SurfaceMaterial scratch;
};

void constructBsdf(benchmark::State& state, const Material& material) {
  const Surface surface(material);
  Cycle<vec3> dirs(makeHemisphereDirs());
  for (auto _ : state) {
    Bsdf bsdf = surface.makeBsdf(dirs.next());
    benchmark::DoNotOptimize(bsdf);
  }
  state.SetItemsProcessed(state.iterations());
}

/// Construction, choice of the class, direction: all that a photon asks of a surface.
void sampleBsdf(benchmark::State& state, const Material& material) {
  const Surface surface(material);
  Cycle<vec3> dirs(makeHemisphereDirs());
  Cycle<vec2> points(makeSquarePoints());
  for (auto _ : state) {
    const Bsdf bsdf = surface.makeBsdf(dirs.next());
    const vec2 u = points.next(), choice = points.next();
    const EventClass event = choice.x < bsdf.specularProbability() ? EventClass::kSpecular : EventClass::kDiffuse;
    auto sample = bsdf.sample(event, u, choice.y, Transport::kFlux);
    benchmark::DoNotOptimize(sample);
  }
  state.SetItemsProcessed(state.iterations());
}

/// Construction and the value for a given direction: all that a shadow ray asks of a surface.
void evaluateBsdf(benchmark::State& state, const Material& material) {
  const Surface surface(material);
  Cycle<vec3> dirs(makeHemisphereDirs());
  for (auto _ : state) {
    const Bsdf bsdf = surface.makeBsdf(dirs.next());
    BsdfValue value = bsdf.evaluate(bsdf.interfaceIsSpecular() ? EventClass::kSpecular : EventClass::kDiffuse,
                                    surface.frame.toWorld(dirs.next()), Transport::kRadiance);
    benchmark::DoNotOptimize(value);
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK_CAPTURE(constructBsdf, diffuse, test::makeDiffuse(vec3(0.6F)))->Name("Bsdf/construct/diffuse");
BENCHMARK_CAPTURE(constructBsdf, glass, test::makeGlass(1.5F))->Name("Bsdf/construct/smooth_glass");
BENCHMARK_CAPTURE(constructBsdf, rough_glass, test::makeGlass(1.5F, 0.4F))->Name("Bsdf/construct/rough_glass");
BENCHMARK_CAPTURE(sampleBsdf, diffuse, test::makeDiffuse(vec3(0.6F)))->Name("Bsdf/sample/diffuse");
BENCHMARK_CAPTURE(sampleBsdf, varnish, makeVarnish())->Name("Bsdf/sample/varnish");
BENCHMARK_CAPTURE(sampleBsdf, glass, test::makeGlass(1.5F))->Name("Bsdf/sample/smooth_glass");
BENCHMARK_CAPTURE(sampleBsdf, rough_glass, test::makeGlass(1.5F, 0.4F))->Name("Bsdf/sample/rough_glass");
BENCHMARK_CAPTURE(sampleBsdf, metal, test::makeMetal(vec3(0.9F, 0.6F, 0.3F), 0.4F))->Name("Bsdf/sample/rough_metal");
BENCHMARK_CAPTURE(evaluateBsdf, diffuse, test::makeDiffuse(vec3(0.6F)))->Name("Bsdf/evaluate/diffuse");
BENCHMARK_CAPTURE(evaluateBsdf, rough_glass, test::makeGlass(1.5F, 0.4F))->Name("Bsdf/evaluate/rough_glass");
BENCHMARK_CAPTURE(evaluateBsdf, metal, test::makeMetal(vec3(0.9F, 0.6F, 0.3F), 0.4F))
    ->Name("Bsdf/evaluate/rough_metal");

}  // namespace
}  // namespace nephroid::bench
