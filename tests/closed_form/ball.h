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

#include <fmt/format.h>

#include "scene/load.h"
#include "support/closed_form.h"
#include "support/closed_form_render.h"

namespace nephroid::closed_form {

struct BallCase {
  double radius = 0.05, ior = 1.5;
  double gap = 0.05;         ///< between the ball's lowest point and the plane, m
  double view_radius = 0.1;  ///< of the profile, m
};

/// Where one order of a ray lands, as |r|; nothing if it leaves upwards. The ray falls along −y at x = −h, about a ball
/// at the origin; turning towards the axis is counter-clockwise.
inline std::optional<double> landOnPlane(const BallCase& c, double theta, double theta_inside, int order) {
  // Polar angle of the point where it leaves: order −1 leaves where it came.
  const double entry = 0.5 * kPiD + theta;
  const double exit = entry + (order + 1) * (kPiD - 2.0 * theta_inside);
  const double turn =
      order < 0 ? -(kPiD - 2.0 * theta) : 2.0 * (theta - theta_inside) + order * (kPiD - 2.0 * theta_inside);
  const double dir = -0.5 * kPiD + turn;
  const double drop = c.radius + c.gap + c.radius * std::sin(exit);
  if (std::sin(dir) >= 0.0) return std::nullopt;
  return std::abs(c.radius * std::cos(exit) - drop * std::cos(dir) / std::sin(dir));
}

/// E / E⊥ in `bins` rings of equal width out to view_radius.
inline std::vector<double> ballIrradiance(const BallCase& c, std::size_t bins) {
  constexpr int kRings = 400'000, kOrders = 6;
  Profile profile(0.0, c.view_radius, bins);
  std::vector<std::optional<double>> previous(kOrders + 2);
  for (int i = 0; i <= kRings; ++i) {
    const double h = c.radius * i / kRings, theta = std::asin(h / c.radius), inside = std::asin(h / c.radius / c.ior);
    const double middle = c.radius * (i - 0.5) / kRings;
    const double cos_middle = std::sqrt(std::max(1.0 - middle * middle / (c.radius * c.radius), 0.0));
    const double r = fresnelReflectance(cos_middle, 1.0, c.ior);
    const double incident = 2.0 * kPiD * middle * c.radius / kRings;
    for (int order = -1; order <= kOrders; ++order) {
      const std::optional<double> landing = landOnPlane(c, theta, inside, order);
      std::optional<double>& last = previous[static_cast<std::size_t>(order + 1)];
      const double share = order < 0 ? r : (1.0 - r) * (1.0 - r) * std::pow(r, order);
      if (i > 0 && landing && last) profile.deposit(*last, *landing, incident * share);
      last = landing;
    }
  }
  return profile.perAnnulus();
}

/// The paraxial focus of a ball is n a / (2(n − 1)) behind its centre.
inline double ballFocalDistance(double radius, double ior) { return ior * radius / (2.0 * (ior - 1.0)); }

inline SceneData makeBallScene(const BallCase& c, int segments) {
  return loadScene(
      fmt::format("builtin:sphere?light=sun&sun-elevation=90&irradiance=1&floor-size=2&radius={}&height={}&ior={}&"
                  "segments={}",
                  c.radius, c.gap, c.ior, segments));
}

inline PlaneView ballView(const BallCase& c, int pixels) {
  PlaneView view;
  view.distance = 0.5 * c.gap;
  view.width = 2.0 * c.view_radius;
  view.columns = view.rows = pixels;
  return view;
}

}  // namespace nephroid::closed_form
