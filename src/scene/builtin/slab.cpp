// A flat pane of solid glass above a floor: it shifts light and dims it, but focuses nothing. The case that can be
// worked out by hand.
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin/scenes.h"
#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"

namespace nephroid {
namespace {

SceneData build(const ParamSet& params, float) {
  const float size = params.getFloat("size"), height = params.getFloat("height");
  const double half = 0.5 * size, half_thickness = 0.5 * params.getFloat("thickness");
  SceneData scene;
  addFloor(scene, params);
  mat4 world_from_slab = glm::translate(mat4(1.0F), vec3(0, height, 0));
  world_from_slab = glm::rotate(world_from_slab, radians(params.getFloat("tilt")), vec3(0, 0, 1));
  addObject(scene,
            makeBox("slab", {-half, -half_thickness, -half}, {half, half_thickness, half}, params.getInt("segments")),
            makeGlass(params, "slab"), world_from_slab);
  addLight(scene, params);
  addCamera(scene, vec3(0, 1.3F, 2.2F) * size, vec3(0, 0.05F, 0) * size, 36);
  return scene;
}

}  // namespace

BuiltinScene describeSlabScene() {
  return {
      "slab", "A pane of solid glass above a floor: light is shifted and dimmed, not focused",
      "closed form: Fresnel, Snell, Beer-Lambert",
      joinParams(
          {lightParams({.sun_elevation_deg = 90, .sun_azimuth_deg = 90, .position = {0, 0.6F, 0}, .target = {0, 0, 0}}),
           {{"size", 0.2F, 1e-6, 1e5, "m", "side of the square slab", {}},
            {"thickness", 0.02F, 1e-7, 1e5, "m", "thickness of the slab", {}},
            {"height", 0.1F, 1e-6, 1e5, "m", "height of the slab's centre above the floor", {}},
            {"tilt", 0.0F, -90.0, 90.0, "deg", "turn about Z: positive lifts the edge at +X", {}}},
           glassParams(1.5F, vec3(1), 0.02F),
           segmentParams(1, "squares along each edge"),
           floorParams(0.6F)}),
      &build};
}

}  // namespace nephroid
