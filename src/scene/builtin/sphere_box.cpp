// A glass ball beside a diffuse box: the caustic runs over the floor and up the box, across a sharp edge.
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin/scenes.h"
#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"

namespace nephroid {
namespace {

SceneData build(const ParamSet& params, float) {
  const float radius = params.getFloat("radius"), side = params.getFloat("box-size");
  SceneData scene;
  addFloor(scene, params);
  const float centre_y = params.getFloat("height") + radius;
  addObject(scene, makeSphere("sphere", {0, centre_y, 0}, radius, params.getInt("segments")),
            makeCaster(params, "sphere", "glass"));
  // The box stands where the light leaves the ball, turned so that its faces are lit at two angles. Its foot is sunk
  // into the floor.
  const double half = 0.5 * side;
  const vec3 place(-(1.25F * radius + 0.62F * side), 0, -0.15F * side);
  const mat4 world_from_box =
      glm::rotate(glm::translate(mat4(1.0F), place), radians(params.getFloat("box-turn")), vec3(0, 1, 0));
  addObject(scene, makeBox("box", {-half, -0.05 * side, -half}, {half, side, half}),
            makeDiffuse("box", params.getVec3("box-color")), world_from_box);
  addLight(scene, params);
  addCamera(scene, vec3(0.4F, 3.8F, 7.0F) * radius, vec3(-1.0F, 0.6F, 0) * radius, 38);
  return scene;
}

}  // namespace

BuiltinScene describeSphereBoxScene() {
  return {"sphere-box", "A glass ball beside a diffuse box that catches part of the caustic", "Larsen, sphere & box",
          joinParams({lightParams({.kind = "point",
                                   .sun_elevation_deg = 40,
                                   .sun_azimuth_deg = 80,
                                   .position = {0.26F, 0.24F, 0.05F},
                                   .target = {0, 0.05F, 0}}),
                      {{"radius", 0.05F, 1e-6, 1e5, "m", "radius of the ball", {}},
                       {"height", 0.005F, 0.0, 1e5, "m", "gap between the ball and the floor", {}},
                       {"box-size", 0.09F, 1e-6, 1e5, "m", "side of the box", {}},
                       {"box-turn", 20.0F, -360.0, 360.0, "deg", "turn of the box about the vertical", {}},
                       {"box-color", vec3(0.75F, 0.62F, 0.5F), 0.0, 1.0, "", "linear RGB albedo of the box", {}}},
                      casterParams("glass", 1.5F, vec3(1), 0.1F),
                      segmentParams(256, "facets around the ball"),
                      floorParams(0.8F)}),
          &build};
}

}  // namespace nephroid
