// Light below a flat slab of glass.
//
// A ray meets the upper face at θ, runs inside at θ' with sin θ = n sin θ', and splits at every face: R is reflected,
// 1 − R goes on, the same R at both faces and from either side (Stokes), since both see the angle pair (θ, θ'). On each
// passage the glass keeps A = exp(−σ t / cos θ') of it, t the thickness. What leaves below after 2k inner reflections
// leaves along θ again, only shifted sideways, so below an endless slab the shares add up:
//
//   T = Σ_k (1 − R) A (R A)^(2k) (1 − R) = (1 − R)² A / (1 − R² A²)          for clear glass = (1 − R)/(1 + R)
//
// and the irradiance on a floor parallel to the slab is E⊥ cos θ · T. R is that of unpolarised light at each face: the
// renderer, like the formula, forgets the polarisation in between.
#pragma once

#include <fmt/format.h>

#include "scene/load.h"
#include "support/closed_form.h"
#include "support/closed_form_render.h"

namespace nephroid::closed_form {

struct SlabCase {
  double angle_deg = 0.0;  ///< of incidence
  double ior = 1.5;
  dvec3 color{1.0};  ///< what white becomes after a path of one thickness
  double thickness = 0.02, size = 1.2, height = 0.06;
};

/// E / E⊥ on the floor, per channel. σ = −ln(color)/thickness, so that A = color^(1 / cos θ').
inline dvec3 slabIrradiance(const SlabCase& c) {
  const double cos_i = std::cos(radiansD(c.angle_deg)), sin_t = std::sin(radiansD(c.angle_deg)) / c.ior;
  const double r = fresnelReflectance(cos_i, 1.0, c.ior);
  const dvec3 kept = glm::pow(c.color, dvec3(1.0 / std::sqrt(1.0 - sin_t * sin_t)));
  return cos_i * (1.0 - r) * (1.0 - r) * kept / (1.0 - r * r * kept * kept);
}

inline SceneData makeSlabScene(const SlabCase& c) {
  // The slab's centre is at `height`; the sun stands over +X.
  return loadScene(fmt::format(
      "builtin:slab?irradiance=1&sun-azimuth=90&sun-elevation={}&size={}&thickness={}&height={}&"
      "ior={}&color={},{},{}&attenuation-distance={}&floor-size=4",
      90.0 - c.angle_deg, c.size, c.thickness, c.height, c.ior, c.color.x, c.color.y, c.color.z, c.thickness));
}

/// A square half as wide as the slab, in the middle of its shadow, so that nothing of the slab's ends shows: every
/// point gets all orders that matter, and none of the light that runs to the far end, is totally reflected there and
/// leaves as a second, backward beam (at 60 degrees it lands 0.4 m from the middle, and 0.03 m nearer for each two
/// inner reflections).
inline PlaneView slabView(const SlabCase& c) {
  const double below = c.height - 0.5 * c.thickness,
               tan_t = std::tan(std::asin(std::sin(radiansD(c.angle_deg)) / c.ior));
  const double shift = below * std::tan(radiansD(c.angle_deg)) + 0.5 * c.thickness * tan_t;
  PlaneView view;
  view.centre = vec3(-static_cast<float>(shift), 0, 0);
  view.distance = 0.5 * below;
  view.width = 0.5 * c.size;
  view.columns = view.rows = 16;
  return view;
}

/// Mean irradiance over the square, per channel.
inline dvec3 meanIrradiance(const PlanePicture& picture) {
  return picture.flux() / (picture.view.width * picture.view.height());
}

}  // namespace nephroid::closed_form
