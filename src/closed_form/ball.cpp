#include "closed_form/ball.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "closed_form/optics.h"
#include "closed_form/profile.h"
#include "scene/load.h"

namespace nephroid::closed_form {

std::optional<double> landOnPlane(const BallCase& c, double theta, double theta_inside, int order) {
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

std::vector<double> ballIrradiance(const BallCase& c, std::size_t bins) {
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

double ballFocalDistance(double radius, double ior) { return ior * radius / (2.0 * (ior - 1.0)); }

SceneData makeBallScene(const BallCase& c, int segments) {
  return loadScene(
      fmt::format("builtin:sphere?light=sun&sun-elevation=90&irradiance=1&floor-size=2&radius={}&height={}&ior={}&"
                  "segments={}",
                  c.radius, c.gap, c.ior, segments));
}

PlaneView ballView(const BallCase& c, int pixels) {
  PlaneView view;
  view.distance = 0.5 * c.gap;
  view.width = 2.0 * c.view_radius;
  view.columns = view.rows = pixels;
  return view;
}

}  // namespace nephroid::closed_form
