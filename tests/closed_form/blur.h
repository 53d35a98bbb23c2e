// How a sun with a size blurs an edge.
//
// A sheet of water (a flat interface, open below) has a straight edge. The sun is a disc of uniform radiance and
// angular diameter α at the zenith. A point of the interface at height d sends its light on to the floor in directions
// with sin θ' = sin θ / n: the disc of directions, uniform in projected solid angle, becomes a disc of landing points
//
//   ρ = d tan θ'_max,   sin θ'_max = sin(α/2) / n,
//
// uniform as far as sin ≈ tan. The edge of the lit floor, at distance s inside the edge of the sheet, sees the part of
// that disc on one side of a line at s from its centre; a segment of a circle gives the edge-spread function
//
//   E(s)/E(∞) = 1/2 + (asin u + u √(1 − u²))/π,   u = s/ρ in [−1, 1].
//
// With n = 1 it is a shadow's penumbra, of width 2 d tan(α/2); water narrows it by n. Light that passes beside the
// sheet meets the floor without an event and is not in the caustic. R varies over the disc by less than 1e-5 of E.
#pragma once

#include <fmt/format.h>

#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"
#include "support/closed_form.h"
#include "support/closed_form_render.h"

namespace nephroid::closed_form {

struct BlurCase {
  double angle_deg = 6.0, ior = 1.33, distance = 1.0;
  double length = 1.0;  ///< of the sheet's edge, which is at x = 0, water at x > 0
};

inline double edgeSpread(double u) {
  const double v = std::clamp(u, -1.0, 1.0);
  return 0.5 + (std::asin(v) + v * std::sqrt(1.0 - v * v)) / kPiD;
}

inline double blurRadius(const BlurCase& c) {
  return c.distance * std::tan(std::asin(std::sin(radiansD(0.5 * c.angle_deg)) / c.ior));
}

/// The width from 10 to 90 %, in units of ρ: twice the root of edgeSpread(u) = 0.9.
inline double edgeWidth() {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) (edgeSpread(0.5 * (low + high)) < 0.9 ? low : high) = 0.5 * (low + high);
  return low + high;
}

/// E / E⊥ at the centres of `bins` columns over |s| <= 1.5 ρ.
inline std::vector<double> blurIrradiance(const BlurCase& c, std::size_t bins) {
  const double plateau = 1.0 - fresnelReflectance(1.0, 1.0, c.ior);
  std::vector<double> irradiance;
  for (std::size_t i = 0; i < bins; ++i)
    irradiance.push_back(plateau * edgeSpread(3.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(bins) - 1.5));
  return irradiance;
}

inline SceneData makeBlurScene(const BlurCase& c) {
  SceneData scene;
  // Wide enough that the other edge's blur ends before the view does: 1.5 ρ + ρ.
  const double half_x = 1.3 * blurRadius(c), half_z = 0.5 * c.length;
  Material water = makeDiffuse("water", vec3(1.0F));
  water.roughness = 0.0F;
  water.specular_factor = 1.0F;
  water.transmission = 1.0F;
  water.thickness = 1.0F;
  water.ior = static_cast<float>(c.ior);
  addObject(scene, makeRectangle("water", {half_x, c.distance, 0}, {half_x, 0, 0}, {0, 0, -half_z}), water);
  addObject(scene, makeRectangle("floor", {0, 0, 0}, {2.0 * c.length, 0, 0}, {0, 0, -2.0 * c.length}),
            makeDiffuse("floor", vec3(0.5F)));
  scene.lights.push_back(makeSun({0, -1, 0}, static_cast<float>(c.angle_deg)));
  return scene;
}

/// |x| <= 1.5 ρ, along the edge as far as the blur of its ends does not reach.
inline PlaneView blurView(const BlurCase& c) {
  PlaneView view;
  view.distance = 0.5 * c.distance;
  view.width = 3.0 * blurRadius(c);
  view.columns = 512;
  view.rows = static_cast<int>((c.length - 2.1 * blurRadius(c)) / view.pixelSize());
  return view;
}

}  // namespace nephroid::closed_form
