// A glass ball that hovers in a room open to the viewer: caustics and reflections on walls of three colours.
#include "scene/builtin/scenes.h"
#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"

namespace nephroid {
namespace {

void addRoom(SceneData& scene, const ParamSet& params) {
  const double half = 0.5 * params.getFloat("box-size"), height = 2 * half;
  const Material white = makeDiffuse("walls", params.getVec3("floor-color"));
  addObject(scene, makeRectangle("floor", {0, 0, 0}, {half, 0, 0}, {0, 0, -half}), white);
  addObject(scene, makeRectangle("back wall", {0, half, -half}, {half, 0, 0}, {0, half, 0}), white);
  addObject(scene, makeRectangle("left wall", {-half, half, 0}, {0, 0, -half}, {0, half, 0}),
            makeDiffuse("left wall", {0.63F, 0.16F, 0.13F}));
  addObject(scene, makeRectangle("right wall", {half, half, 0}, {0, 0, half}, {0, half, 0}),
            makeDiffuse("right wall", {0.16F, 0.36F, 0.63F}));
  if (params.getBool("ceiling"))
    addObject(scene, makeRectangle("ceiling", {0, height, 0}, {half, 0, 0}, {0, 0, half}), white);
}

SceneData build(const ParamSet& params, float) {
  const float radius = params.getFloat("radius"), size = params.getFloat("box-size");
  SceneData scene;
  addRoom(scene, params);
  addObject(scene, makeSphere("sphere", {0, params.getFloat("height") + radius, 0}, radius, params.getInt("segments")),
            makeCaster(params, "sphere", "glass"));
  addLight(scene, params);
  addCamera(scene, vec3(0, 0.5F, 1.9F) * size, vec3(0, 0.46F, 0) * size, 40);
  return scene;
}

}  // namespace

BuiltinScene describeSphereInBoxScene() {
  return {
      "sphere-in-box", "A glass ball in a room with coloured walls, open towards the viewer", "Larsen, sphere in box",
      joinParams({lightParams({.kind = "point",
                               .sun_elevation_deg = 40,
                               .sun_azimuth_deg = 10,
                               .position = {0.04F, 0.27F, 0.05F},
                               .target = {0, 0.11F, 0}}),
                  {{"radius", 0.05F, 1e-6, 1e5, "m", "radius of the ball", {}},
                   {"height", 0.06F, 0.0, 1e5, "m", "gap between the ball and the floor", {}},
                   {"box-size", 0.3F, 1e-6, 1e5, "m", "side of the room", {}},
                   {"ceiling", false, 0, 0, "", "close the room at the top (a sun then shines in at the front)", {}},
                   {"floor-color", vec3(0.7F), 0.0, 1.0, "", "linear RGB albedo of floor, back wall and ceiling", {}}},
                  casterParams("glass", 1.5F, vec3(1), 0.1F),
                  segmentParams(256, "facets around the ball")}),
      &build};
}

}  // namespace nephroid
