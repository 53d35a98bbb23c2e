// A glass ball over a floor: the simplest caustic, a cusp of revolution.
#include "scene/builtin/scenes.h"
#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"

namespace nephroid {
namespace {

SceneData build(const ParamSet& params, float) {
  const float radius = params.getFloat("radius");
  SceneData scene;
  addFloor(scene, params);
  const float centre_y = params.getFloat("height") + radius;
  addObject(scene, makeSphere("sphere", {0, centre_y, 0}, radius, params.getInt("segments")),
            makeCaster(params, "sphere", "glass"));
  addLight(scene, params);
  addCamera(scene, vec3(0, 3.6F, 6.4F) * radius, vec3(-0.5F, 0.5F, 0) * radius, 36);
  return scene;
}

}  // namespace

BuiltinScene describeSphereScene() {
  return {"sphere", "A glass ball over a floor", "Wyman et al.; Shah et al. Fig. 9; Larsen, single sphere",
          joinParams({lightParams({.kind = "point",
                                   .sun_elevation_deg = 55,
                                   .sun_azimuth_deg = 70,
                                   .position = {0.2F, 0.3F, 0.06F},
                                   .target = {0, 0.05F, 0}}),
                      {{"radius", 0.05F, 1e-6, 1e5, "m", "radius of the ball", {}},
                       {"height", 0.01F, 0.0, 1e5, "m", "gap between the ball and the floor", {}}},
                      casterParams("glass", 1.5F, vec3(1), 0.1F),
                      segmentParams(256, "facets around the ball"),
                      floorParams(0.6F)}),
          &build};
}

}  // namespace nephroid
