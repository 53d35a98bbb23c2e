// A glass cube over a floor: flat faces, so the caustic is a set of shifted, overlapping images of them.
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin/scenes.h"
#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"

namespace nephroid {
namespace {

SceneData build(const ParamSet& params, float) {
  const float size = params.getFloat("size");
  const double half = 0.5 * size;
  SceneData scene;
  addFloor(scene, params);
  const mat4 lifted = glm::translate(mat4(1.0F), vec3(0, params.getFloat("height"), 0));
  addObject(scene, makeBox("cube", {-half, 0, -half}, {half, size, half}, params.getInt("segments")),
            makeCaster(params, "cube", "glass"), glm::rotate(lifted, radians(params.getFloat("turn")), vec3(0, 1, 0)));
  addLight(scene, params);
  addCamera(scene, vec3(0, 2.3F, 4.0F) * size, vec3(-0.3F, 0.2F, -0.2F) * size, 36);
  return scene;
}

}  // namespace

BuiltinScene describeCubeScene() {
  return {"cube", "A glass cube over a floor", "Wyman et al., cube",
          joinParams({lightParams({.sun_elevation_deg = 50,
                                   .sun_azimuth_deg = 60,
                                   .position = {0.25F, 0.35F, 0.15F},
                                   .target = {0, 0.03F, 0}}),
                      {{"size", 0.06F, 1e-6, 1e5, "m", "edge of the cube", {}},
                       {"height", 0.005F, 1e-7, 1e5, "m", "gap between the cube and the floor", {}},
                       {"turn", 25.0F, -360.0, 360.0, "deg", "turn of the cube about the vertical", {}}},
                      casterParams("glass", 1.5F, vec3(1), 0.06F),
                      segmentParams(1, "squares along each edge"),
                      floorParams(0.5F)}),
          &build};
}

}  // namespace nephroid
