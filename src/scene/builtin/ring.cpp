// A metal ring on a floor: light that enters over the rim meets the inside wall and draws a cardioid-like curve; light
// that meets the outside wall draws a bright band outside.
#include "scene/builtin/scenes.h"
#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"

#include "nephroid/error.h"

namespace nephroid {
namespace {

constexpr vec3 kBrass(0.91F, 0.78F, 0.42F);

/// A tube with square edges. Its foot is sunk into the floor, so that no two faces coincide there.
Mesh makeRing(double radius, double height, double wall, int segments) {
  const double inner = radius - wall, foot = -0.1 * height;
  std::vector<ProfilePoint> profile;
  appendLine(profile, {inner, foot}, {radius, foot});
  appendLine(profile, {radius, foot}, {radius, height});
  appendLine(profile, {radius, height}, {inner, height});
  appendLine(profile, {inner, height}, {inner, foot});
  return makeRevolution("ring", profile, segments);
}

SceneData build(const ParamSet& params, float) {
  const float radius = params.getFloat("radius"), wall = params.getFloat("wall");
  if (wall >= radius) throw UsageError("wall must be smaller than radius");
  SceneData scene;
  addFloor(scene, params);
  addObject(scene, makeRing(radius, params.getFloat("height"), wall, params.getInt("segments")),
            makeCaster(params, "ring", "metal"));
  addLight(scene, params);
  addCamera(scene, vec3(0, 5.2F, 5.2F) * radius, vec3(0, 0, -0.2F) * radius, 33);
  return scene;
}

}  // namespace

BuiltinScene describeRingScene() {
  return {"ring", "A brass ring on a floor: a cardioid inside, a band of light outside",
          "Shah et al. Fig. 12; Larsen, brass ring; Wyman et al., metal ring",
          joinParams({lightParams({.kind = "point",
                                   .sun_elevation_deg = 35,
                                   .sun_azimuth_deg = 60,
                                   .position = {0.2F, 0.12F, 0.08F},
                                   .target = {0, 0, 0}}),
                      {{"radius", 0.05F, 1e-6, 1e5, "m", "outer radius of the ring", {}},
                       {"height", 0.025F, 1e-6, 1e5, "m", "height of the ring above the floor", {}},
                       {"wall", 0.002F, 1e-7, 1e5, "m", "thickness of the ring's wall", {}}},
                      casterParams("metal", 1.5F, kBrass, 0.05F),
                      segmentParams(256, "facets around the ring"),
                      floorParams(0.6F)}),
          &build};
}

}  // namespace nephroid
