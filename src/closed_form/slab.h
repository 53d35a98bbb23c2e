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

#include "closed_form/plane_picture.h"

namespace nephroid::closed_form {

struct SlabCase {
  double angle_deg = 0.0;  ///< of incidence
  double ior = 1.5;
  dvec3 color{1.0};  ///< what white becomes after a path of one thickness
  double thickness = 0.02, size = 1.2, height = 0.06;
};

/// E / E⊥ on the floor, per channel. σ = −ln(color)/thickness, so that A = color^(1 / cos θ').
dvec3 slabIrradiance(const SlabCase& c);

SceneData makeSlabScene(const SlabCase& c);

/// A square half as wide as the slab, in the middle of its shadow, so that nothing of the slab's ends shows: every
/// point gets all orders that matter, and none of the light that runs to the far end, is totally reflected there and
/// leaves as a second, backward beam (at 60 degrees it lands 0.4 m from the middle, and 0.03 m nearer for each two
/// inner reflections).
PlaneView slabView(const SlabCase& c);

/// Mean irradiance over the square, per channel.
dvec3 meanIrradiance(const PlanePicture& picture);

}  // namespace nephroid::closed_form
