// The primary rainbow of a drop of water.
//
// A ray that meets a ball at i (sin i is its distance from the axis over the radius) runs inside at r, sin i = n sin r,
// is mirrored once at the back and leaves at i again. It is turned by i − r on entering, by π − 2r at the back and by
// i − r on leaving:
//
//   D(i) = π + 2i − 4r.
//
// dD/di = 2 − 4 cos i / (n cos r) vanishes where n² cos² r = 4 cos² i; with n² cos² r = n² − sin² i,
//
//   cos i = √((n² − 1)/3).
//
// There D is least and light is densest: the bow, at π − D = 4r − 2i from the point opposite to the sun, beyond which
// no such light comes. The ray passes the drop's centre at sin i radii, so on a screen at a distance of ρ radii it is
// seen asin(sin i / ρ) further out.
#pragma once

#include <cstddef>
#include <vector>

#include "closed_form/plane_picture.h"

namespace nephroid::closed_form {

struct DropCase {
  double ior = 1.333, abbe = 55.8;  // water
  double distance = 3000.0;         // of the screen, in radii of the drop
  double angle_deg = 42.0;          // of the screen's middle from the drop's axis
  double half_angle_deg = 3.0;      // of the screen
};

/// Where on the screen the bow ends, from the axis, rad.
double bowAngle(const DropCase& c, double ior);

/// The screen seen squarely: rows across the bow, the outside on top.
PlaneView dropView(const DropCase& c);

/// A ball of radius 1 under a sun from above, and a screen that is small and far enough to stand beside its light.
SceneData makeDropScene(const DropCase& c);

/// RGB flux by angle from the axis, in equal bins over [lower, upper], rad.
std::vector<dvec3> angularProfile(const PlanePicture& picture, double lower, double upper, std::size_t bins);

/// How far the edge of each band's bow is from where its index puts it, degrees, to 0.02: as many as there are bands.
/// @param picture  of `dropView` with that many bands, each of one wavelength
std::vector<double> bowErrors_deg(const DropCase& c, const PlanePicture& picture);

/// Bands that `bowErrors_deg` tells apart: colours are sums over bands, and three can be told from three channels.
inline constexpr int kBowBands = 3;

}  // namespace nephroid::closed_form
