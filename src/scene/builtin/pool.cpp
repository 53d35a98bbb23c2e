// A pool with walls, into which drops fall: rings spread over the water, and their caustics dance on floor and walls.
#include "scene/builtin/scenes.h"
#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"
#include "scene/builtin/water.h"

#include "nephroid/error.h"

namespace nephroid {
namespace {

constexpr float kShownSeconds = 10.0F;  // the rain never ends; this is how much of it an animation shows

PlopSettings readPlops(const ParamSet& params) {
  return {.size_x = params.getFloat("width"),
          .size_z = params.getFloat("length"),
          .rate = params.getFloat("rate"),
          .amplitude = params.getFloat("amplitude"),
          .wavelength = params.getFloat("wavelength"),
          .speed = params.getFloat("speed"),
          .lifetime = params.getFloat("lifetime"),
          .seed = params.getInt("seed")};
}

SceneData build(const ParamSet& params, float time) {
  const float width = params.getFloat("width"), length = params.getFloat("length"), depth = params.getFloat("depth");
  if (params.getFloat("amplitude") > 0.25F * depth) throw UsageError("amplitude must be at most a quarter of depth");
  const double wall = 0.05 * std::min(width, length), freeboard = 0.25 * depth;
  const PlopSurface plops(readPlops(params), time);
  SceneData scene;
  scene.duration = kShownSeconds;
  addObject(scene, makeBasin("basin", width, length, 0, depth + freeboard, wall),
            makeDiffuse("tiles", params.getVec3("floor-color")));
  // The surface reaches half way into the walls: no gap shows at the edge, no edge lies on a wall.
  const int cells = params.getInt("segments");
  addObject(scene,
            makeHeightField("water", width + wall, length + wall, cells, cells,
                            [&](double x, double z) {
                              HeightSample sample = plops.at(x, z);
                              sample.y += depth;
                              return sample;
                            }),
            makeGlass(params, "water"));
  addLight(scene, params);
  const float reach = std::max(width, length);
  addCamera(scene, vec3(0, 1.5F, 0.95F) * reach, vec3(0, 0.12F, 0.0F) * reach, 42);
  return scene;
}

}  // namespace

BuiltinScene describePoolScene() {
  return {"pool", "A tiled pool into which drops fall; a function of time",
          "Shah et al., pool with random plops on a 100 x 100 mesh",
          joinParams({lightParams({.sun_elevation_deg = 65,
                                   .sun_azimuth_deg = 120,
                                   .position = {1.5F, 5.0F, -1.0F},
                                   .target = {0, 1.0F, 0}}),
                      {{"width", 4.0F, 1e-6, 1e5, "m", "inside of the pool along X", {}},
                       {"length", 4.0F, 1e-6, 1e5, "m", "inside of the pool along Z", {}},
                       {"depth", 1.2F, 1e-6, 1e5, "m", "depth of the water", {}},
                       {"amplitude", 0.035F, 0.0, 1e4, "m", "height of a ring of waves as it starts", {}},
                       {"wavelength", 0.5F, 1e-6, 1e5, "m", "length of the waves in a ring", {}},
                       {"speed", 0.6F, 1e-6, 1e5, "m/s", "speed at which rings spread", {}},
                       {"lifetime", 3.0F, 1e-3, 1e3, "s", "time in which a ring falls to 37 %", {}},
                       {"rate", 1.5F, 0.0, 100.0, "1/s", "drops per second", {}},
                       {"seed", 1, 0.0, 1e9, "", "chooses where and when drops fall", {}},
                       {"floor-color", vec3(0.7F), 0.0, 1.0, "", "linear RGB albedo of floor and walls", {}}},
                      glassParams(1.33F, {0.7F, 0.92F, 0.95F}, 3.0F),
                      segmentParams(100, "cells along each side of the water")}),
          &build};
}

}  // namespace nephroid
