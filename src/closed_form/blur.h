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

#include <cstddef>
#include <optional>
#include <vector>

#include "closed_form/plane_picture.h"

namespace nephroid::closed_form {

struct BlurCase {
  double angle_deg = 6.0, ior = 1.33, distance = 1.0;
  double length = 1.0;  ///< of the sheet's edge, which is at x = 0, water at x > 0
};

double edgeSpread(double u);

double blurRadius(const BlurCase& c);

/// The width from 10 to 90 %, in units of ρ: twice the root of edgeSpread(u) = 0.9.
double edgeWidth();

/// E / E⊥ at the centres of `bins` columns over |s| <= 1.5 ρ.
std::vector<double> blurIrradiance(const BlurCase& c, std::size_t bins);

SceneData makeBlurScene(const BlurCase& c);

/// |x| <= 1.5 ρ, along the edge as far as the blur of its ends does not reach.
PlaneView blurView(const BlurCase& c);

/// The width from 10 to 90 % of the plateau in a picture of `blurView`, in units of ρ; nothing where there is no edge.
/// Over bins of 8 pixels, so that single photons do not decide where a level is crossed.
std::optional<double> measureEdgeWidth(const BlurCase& c, const PlanePicture& picture);

}  // namespace nephroid::closed_form
