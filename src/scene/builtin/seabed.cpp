// A fish over a rugged sea bed under moving water: the receivers are neither flat nor at one depth.
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include "nephroid/error.h"
#include "scene/builtin/hash.h"
#include "scene/builtin/scenes.h"
#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"
#include "scene/builtin/water.h"

namespace nephroid {
namespace {

constexpr double kTau = 6.283185307179586476925;
constexpr float kShownSeconds = 10.0F;
/// The bed is wider than the water: seen aslant through its edge there is still ground.
constexpr float kBedMargin = 1.6F;

/// The body of a fish of length 1 that swims towards −X: elliptic sections whose height and width follow a drop.
/// u runs from the tail (x = 1/2) to the nose (x = −1/2).
SurfaceSample sampleBody(double u, double v) {
  const double angle = 0.5 * kTau * u, sine = u == 0.0 || u == 1.0 ? 0.0 : std::sin(angle), cosine = std::cos(angle);
  // Thin towards the tail: the taper t = 0.62 − 0.38 x' with x' = cos(angle) in [−1, 1].
  const double taper = 0.62 - 0.38 * cosine, taper_du = 0.38 * sine;
  const double ring = sine * taper, ring_du = cosine * taper + sine * taper_du;  // per radian of `angle`
  constexpr double kHeight = 0.14, kWidth = 0.085;
  const double sv = std::sin(v), cv = std::cos(v);
  const dvec3 position(0.5 * cosine, kHeight * ring * sv, kWidth * ring * cv);
  if (sine == 0.0) return {position, {cosine > 0 ? 1 : -1, 0, 0}};
  const dvec3 along(-0.5 * sine, kHeight * ring_du * sv, kWidth * ring_du * cv), around(0, kHeight * cv, -kWidth * sv);
  return {position, glm::normalize(glm::cross(around, along))};
}

/// A fin: a flat triangle of the given thickness in the xy plane of the fish, corners in either order.
Mesh makeFin(std::string name, dvec2 a, dvec2 b, dvec2 c, double thickness) {
  const dvec2 ab = b - a, ac = c - a;
  if (ab.x * ac.y < ab.y * ac.x) std::swap(b, c);
  const std::array<dvec2, 3> corners{a, b, c};
  return makePrism(std::move(name), corners, -0.5 * thickness, 0.5 * thickness);
}

void addFish(SceneData& scene, const ParamSet& params, const mat4& world_from_fish) {
  const int segments = params.getInt("segments");
  const Material skin = makeDiffuse("fish", params.getVec3("fish-color"));
  addObject(scene, makePolarSurface("fish", std::max(segments / 2, 8), std::max(segments / 4, 8), sampleBody), skin,
            world_from_fish);
  constexpr double kThickness = 0.008;
  addObject(scene, makeFin("tail fin, upper", {0.44, 0.0}, {0.66, 0.17}, {0.50, 0.02}, kThickness), skin,
            world_from_fish);
  addObject(scene, makeFin("tail fin, lower", {0.44, 0.0}, {0.50, -0.02}, {0.62, -0.11}, kThickness), skin,
            world_from_fish);
  addObject(scene, makeFin("back fin", {-0.10, 0.07}, {0.10, 0.05}, {0.09, 0.20}, kThickness), skin, world_from_fish);
  const float tilt = radians(105);
  for (const float side : {-1.0F, 1.0F})
    addObject(scene, makeFin("side fin", {-0.16, -0.01}, {0.0, -0.01}, {0.06, 0.18}, kThickness), skin,
              glm::rotate(world_from_fish, side * tilt, vec3(1, 0, 0)));
}

/// Ridges and bumps: waves of many lengths and directions, the shorter the lower.
std::vector<PlaneWave> makeBed(double height, double wavelength, int seed) {
  std::vector<PlaneWave> waves;
  for (int i = 0; i < 12; ++i) {
    const double factor = std::pow(0.84, i);
    waves.push_back({0.2 * height * std::pow(factor, 1.1), wavelength * factor, kTau * hashToUnit(seed, i, 10),
                     kTau * hashToUnit(seed, i, 11)});
  }
  return waves;
}

SceneData build(const ParamSet& params, float time) {
  const float size = params.getFloat("size"), depth = params.getFloat("depth"), relief = params.getFloat("relief");
  if (relief + params.getFloat("amplitude") > 0.6F * depth)
    throw UsageError("relief and amplitude together must be at most 0.6 of depth");
  const std::vector<PlaneWave> bed = makeBed(relief, 0.4 * size, params.getInt("seed"));
  std::vector<PlaneWave> waves = makePlaneWaves(params.getInt("waves"), params.getFloat("amplitude"),
                                                params.getFloat("wavelength"), params.getInt("seed"));
  // Deep-water waves: ω² = g k, so that short ones run slower.
  for (PlaneWave& wave : waves) wave.phase -= std::sqrt(9.81 * kTau / wave.wavelength) * time;
  const int cells = params.getInt("segments");
  const int bed_cells = static_cast<int>(std::ceil(kBedMargin * static_cast<float>(cells)));
  SceneData scene;
  scene.duration = kShownSeconds;
  addObject(scene,
            makeHeightField("bed", kBedMargin * size, kBedMargin * size, bed_cells, bed_cells,
                            [&](double x, double z) { return evaluateWaves(bed, x, z); }),
            makeDiffuse("sand", params.getVec3("floor-color")));
  addFish(scene, params,
          glm::scale(glm::rotate(glm::translate(mat4(1.0F), vec3(0, 0.52F * depth, 0.03F * size)), radians(-25),
                                 vec3(0, 1, 0)),
                     vec3(params.getFloat("fish-length"))));
  addObject(scene,
            makeHeightField("water", size, size, cells, cells,
                            [&](double x, double z) {
                              HeightSample sample = evaluateWaves(waves, x, z);
                              sample.y += depth;
                              return sample;
                            }),
            makeGlass(params, "water"));
  addLight(scene, params);
  addCamera(scene, vec3(0, 0.42F * size + depth, 0.38F * size), vec3(0, 0.3F * depth, 0.03F * size), 40);
  return scene;
}

}  // namespace

BuiltinScene describeSeabedScene() {
  return {"seabed", "A fish over a rugged sea bed under waves; a function of time",
          "Shah et al., shark over a rugged sea bed",
          joinParams({lightParams({.sun_elevation_deg = 70,
                                   .sun_azimuth_deg = 60,
                                   .position = {4.0F, 12.0F, 2.0F},
                                   .target = {0, 2.0F, 0}}),
                      {{"size", 10.0F, 1e-6, 1e5, "m", "side of the square patch of sea", {}},
                       {"depth", 3.0F, 1e-6, 1e5, "m", "mean depth of the water", {}},
                       {"relief", 0.8F, 0.0, 1e4, "m", "height of the ridges of the bed", {}},
                       {"fish-length", 2.4F, 1e-6, 1e5, "m", "length of the fish", {}},
                       {"fish-color", vec3(0.36F, 0.42F, 0.5F), 0.0, 1.0, "", "linear RGB albedo of the fish", {}},
                       {"amplitude", 0.06F, 0.0, 1e4, "m", "height of the longest wave above the mean", {}},
                       {"wavelength", 1.6F, 1e-6, 1e5, "m", "length of the longest wave", {}},
                       {"waves", 6, 1.0, 32.0, "", "number of waves", {}},
                       {"seed", 1, 0.0, 1e9, "", "chooses the bed and the waves", {}},
                       {"floor-color", vec3(0.68F, 0.62F, 0.5F), 0.0, 1.0, "", "linear RGB albedo of the bed", {}}},
                      glassParams(1.33F, {0.65F, 0.9F, 0.95F}, 4.0F),
                      segmentParams(200, "cells along each side of bed and water")}),
          &build};
}

}  // namespace nephroid
