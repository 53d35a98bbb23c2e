// The caustic of a glass ball under a sun, on a plane behind it.
//
// A ray at distance h from the axis meets the ball (radius a) at θ with sin θ = h/a and refracts to θ', sin θ = n sin
// θ'. It stays in its meridional plane, and every further hit is at θ' again, so all reflectances on the way are the
// same R(θ). It gives off
//
//   outside        share R             turned by  π − 2θ
//   order k >= 0   share (1 − R)² R^k  turned by  2(θ − θ') + k(π − 2θ')
//
// (towards the axis and beyond). A ring of rays h … h + dh carries 2π h dh E⊥ and lands on the ring r(h) … r(h + dh):
//
//   E(r) = Σ over all h with |r(h)| = r, over all orders, of  E⊥ share(h) h / (r |dr/dh|).
//
// r(h) has its fold where the caustic surface cuts the plane, and r = 0 at h ≠ 0 before the paraxial focus, at
// n a / (2(n − 1)) from the centre; E is infinite in both places. Hence rings of h are mapped to intervals of r and
// gathered in bins, which are finite everywhere.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "closed_form/plane_picture.h"

namespace nephroid::closed_form {

struct BallCase {
  double radius = 0.05, ior = 1.5;
  double gap = 0.05;         ///< between the ball's lowest point and the plane, m
  double view_radius = 0.1;  ///< of the profile, m
};

/// Where one order of a ray lands, as |r|; nothing if it leaves upwards. The ray falls along −y at x = −h, about a ball
/// at the origin; turning towards the axis is counter-clockwise.
std::optional<double> landOnPlane(const BallCase& c, double theta, double theta_inside, int order);

/// E / E⊥ in `bins` rings of equal width out to view_radius.
std::vector<double> ballIrradiance(const BallCase& c, std::size_t bins);

/// The paraxial focus of a ball is n a / (2(n − 1)) behind its centre.
double ballFocalDistance(double radius, double ior);

SceneData makeBallScene(const BallCase& c, int segments);

PlaneView ballView(const BallCase& c, int pixels);

}  // namespace nephroid::closed_form
