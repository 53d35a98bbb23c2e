// A patch of wavy water above a floor: an open interface, no sides, no bottom but the floor.
//
// With waves=1 the surface is y = depth + amplitude · cos(2π x / wavelength), whose caustics can be worked out by hand.
#include "scene/builtin/scenes.h"
#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"
#include "scene/builtin/water.h"

#include "nephroid/error.h"

namespace nephroid {
namespace {

SceneData build(const ParamSet& params, float) {
  const float size = params.getFloat("size"), depth = params.getFloat("depth");
  const std::vector<PlaneWave> waves = makePlaneWaves(params.getInt("waves"), params.getFloat("amplitude"),
                                                      params.getFloat("wavelength"), params.getInt("seed"));
  double crest = 0;
  for (const PlaneWave& wave : waves) crest += wave.amplitude;
  if (crest >= depth) throw UsageError("the waves reach the floor; make amplitude smaller or depth larger");
  SceneData scene;
  addFloor(scene, params);
  const int cells = params.getInt("segments");
  addObject(scene,
            makeHeightField("water", size, size, cells, cells,
                            [&](double x, double z) {
                              HeightSample sample = evaluateWaves(waves, x, z);
                              sample.y += depth;
                              return sample;
                            }),
            makeGlass(params, "water"));
  addLight(scene, params);
  addCamera(scene, vec3(0, 1.35F, 1.25F) * size, vec3(0, 0.05F, 0) * size, 36);
  return scene;
}

}  // namespace

BuiltinScene describeWaveScene() {
  return {"wave", "Wavy water above a floor; with waves=1 a single cosine along X",
          "Larsen, wave plane; closed form with waves=1",
          joinParams({lightParams({.sun_elevation_deg = 90, .position = {0.4F, 2.5F, 0}, .target = {0, 0, 0}}),
                      {{"size", 2.0F, 1e-6, 1e5, "m", "side of the square patch of water", {}},
                       {"depth", 0.5F, 1e-6, 1e5, "m", "mean depth of the water", {}},
                       {"amplitude", 0.02F, 0.0, 1e4, "m", "height of the longest wave above the mean", {}},
                       {"wavelength", 0.5F, 1e-6, 1e5, "m", "length of the longest wave", {}},
                       {"waves", 3, 1.0, 32.0, "", "number of waves; 1 is a pure cosine with its crest at x = 0", {}},
                       {"seed", 1, 0.0, 1e9, "", "chooses direction and phase of all waves but the first", {}}},
                      glassParams(1.33F, vec3(1), 5.0F),
                      segmentParams(256, "cells along each side of the water"),
                      floorParams(3.0F)}),
          &build};
}

}  // namespace nephroid
