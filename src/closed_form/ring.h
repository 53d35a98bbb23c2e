// The nephroid: sunlight inside a reflecting circle.
//
// A ring of inner radius a and height H stands on the floor. The sun, at elevation ε over +X, shines over the near rim
// onto the far inner wall. Seen from above, a ray along (−1, 0) meets the wall at P(φ) = a (−cos φ, sin φ), |φ| < π/2,
// at the angle φ to its normal; at height y it has come over the near rim if
//
//   y + 2 a cos φ tan ε >= H        (2 a cos φ is the chord that it crossed).
//
// The wall is upright, so the reflection turns the horizontal direction alone, into u(φ) = (cos 2φ, −sin 2φ), and the
// ray goes on falling by tan ε per horizontal length. It reaches the floor after ℓ = y / tan ε. If ℓ is longer than the
// chord 2 a cos φ it meets the wall once more, at the same angle φ (a chord's ends are alike), is turned by the angle π
// − 2φ again, and so on. Per reflection ρ(cos ε cos φ) of it is left, by Schlick, which here is the definition of the
// material.
//
// A patch a dφ dy of the wall receives E⊥ cos ε cos φ a dφ dy. It lands on the floor on
//
//   |∂(P + ℓ u)/∂φ × ∂(P + ℓ u)/∂y| dφ dy = |a cos φ − 2 ℓ| / tan ε dφ dy,
//
// because P' × u = a cos φ and u turns by 2 per φ. So with ℓ = y / tan ε the irradiance of the first reflection is
// E⊥ ρ a cos ε cos φ tan ε / |a cos φ − 2ℓ|, infinite on the envelope ℓ = (a/2) cos φ, whose points
//
//   N(φ) = a (−cos φ, sin φ) + (a/2) cos φ (cos 2φ, −sin 2φ) = (a/4) (cos 3φ − 3 cos φ, 3 sin φ − sin 3φ)
//
// are a nephroid with its cusp at (−a/2, 0). It is drawn in full if H >= (a/2) tan ε. On the axis, φ = 0, the next
// reflection's light comes together farther on. Patches (φ, y) are mapped to the floor and gathered in pixels.
#pragma once

#include <vector>

#include "closed_form/plane_picture.h"
#include "core/image/image.h"

namespace nephroid::closed_form {

struct RingCase {
  double inner_radius = 0.048, wall = 0.002, height = 0.03;
  double sun_elevation_deg = 45.0, reflectance = 0.9;
};

/// A point of the caustic curve.
dvec2 nephroidPoint(double radius, double phi);

/// Where a ray that meets the wall at (φ, y) ends on the floor (x, z), and the share of its flux that is left.
struct RingLanding {
  dvec2 position{0};
  double share = 0;
};
RingLanding traceRing(const RingCase& c, double phi, double y);

/// E / E⊥ on `pixels`² squares of [−a, a]²: x to the right, z downwards (towards the viewer); a picture of one channel.
Image ringIrradiance(const RingCase& c, int pixels);

SceneData makeRingScene(const RingCase& c, int segments);

/// Sums over squares of 8 × 8 pixels that lie inside the circle: the corners get light from the ring's outside too.
std::vector<double> sumSquares(const Image& image);

/// Means over an even number of rows about the axis.
std::vector<double> axisProfile(const Image& image, int rows);

/// How far the brightest pixels of some columns are from the nephroid: the worst, in pixels.
///
/// Down each of these columns the brightest pixel lies on the curve: inside there are more rays, at the fold infinitely
/// many. The columns cross the upper branch, φ from 45 to 75 degrees, which has |z| > a/(2√2); the cusp's light is
/// below. @param picture  of ringView(c, 512)
double nephroidDistance(const RingCase& c, const PlanePicture& picture);

/// x of the cusp, over the inner radius. By the formula it is −1/2.
///
/// The two rows about the axis are a strip |z| <= w of one pixel. Near the cusp N(φ)/a = (−1/2 − 3φ²/4, φ³): the strip
/// holds both folds up to φ = (w/a)^(1/3) and is brightest where they leave it, at x/a = −1/2 − (3/4)(w/a)^(2/3).
double cuspPosition(const RingCase& c, const PlanePicture& picture);

/// The inside of the ring, seen from below its rim.
PlaneView ringView(const RingCase& c, int pixels);

}  // namespace nephroid::closed_form
