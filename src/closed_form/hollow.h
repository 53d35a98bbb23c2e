// The caustic of a hollow glass sphere under a sun, on a plane behind it.
//
// A ball of radius a and index n about a cavity of radius b, the same centre. Every ray stays in its meridional plane,
// and n times its distance from the centre, the impact parameter, is h in all of its parts (Bouguer): h outside, h/n in
// the glass, h in the cavity. So
//
//   h < b          meets the cavity at the angle φ in the glass, sin φ = h/(n b), and goes straight through it: four
//                  interfaces, of which each bends it by less and the other way than a solid ball's would
//   b <= h < n b   is reflected totally at the cavity
//   h >= n b       passes beside it, as in a ball
//
// At every interface what is reflected goes on too. A ring of rays h … h + dh carries 2π h dh E⊥; followed along one
// sequence of interfaces, reflected or let through at each, it lands on the ring r(h) … r(h + dh) with the share that
// is the product of the Fresnel factors. Sequences are gathered in bins, those that carry less than a ten-thousandth
// left out; folds, where |dr/dh| = 0, are intervals of h like any other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "closed_form/ball.h"

namespace nephroid::closed_form {

struct HollowCase {
  BallCase ball;
  double inner_radius = 0.03;
};

/// Where a ray of one sequence of interfaces lands, as |r|, and what it carries there.
struct HollowLanding {
  double radius, share;
};

/// By sequence: two bits for each interface, reflected (0) or let through (1), of the outside (0) or the cavity (2).
using HollowLandings = std::map<std::uint64_t, HollowLanding>;

/// The ray that falls along −y at x = −h, about a centre at the origin, and what it splits into.
HollowLandings traceHollow(const HollowCase& c, double h);

/// E / E⊥ in `bins` rings of equal width out to view_radius.
std::vector<double> hollowIrradiance(const HollowCase& c, std::size_t bins);

SceneData makeHollowScene(const HollowCase& c, int segments);

}  // namespace nephroid::closed_form
