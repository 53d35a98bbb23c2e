// Deviation of a prism.
//
// In a plane across the edge, with apex angle A: light enters at i, runs inside at i' (sin i = n sin i'), meets the
// second face at e' = A − i' (the two normals enclose A) and leaves at e, sin e = n sin e'. It was turned by i − i' and
// then by e − e', both towards the base:
//
//   δ(i) = i + asin(n sin(A − asin(sin i / n))) − A.
//
// Light may run either way, so δ as a function of i has the same value at i and at e(i); being convex it is least where
// i = e, hence i' = e' = A/2 and
//
//   δ_min = 2 asin(n sin(A/2)) − A.
//
// The renderer's angle is measured, not asked for: the same beam is caught on the floor with the prism at two heights,
// and the way by which its centre moves per height is the cotangent of its elevation.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "scene/load.h"
#include "support/closed_form.h"
#include "support/closed_form_render.h"

namespace nephroid::closed_form {

struct PrismCase {
  double apex_deg = 60.0, ior = 1.5, abbe = 0.0;
  double incidence_deg = 48.6;
  double sun_elevation_deg = 30.0;
};

inline double prismDeviation(double apex, double incidence, double ior) {
  const double inside = std::asin(std::sin(incidence) / ior);
  return incidence + std::asin(ior * std::sin(apex - inside)) - apex;
}
inline double prismMinimumDeviation(double apex, double ior) {
  return 2.0 * std::asin(ior * std::sin(0.5 * apex)) - apex;
}

/// A beam of 1 mm on the axis of a prism of 40 mm, `height` above the floor. The sun stands at −X. With the prism
/// turned by t from apex up, its lit face looks up by A/2 + t short of −X's opposite, that is, light meets it at t +
/// A/2 − elevation.
inline SceneData makePrismScene(const PrismCase& c, double height, double floor_size = 4.0) {
  const double turn = c.incidence_deg - 0.5 * c.apex_deg + c.sun_elevation_deg;
  return loadScene(
      fmt::format("builtin:prism?light=sun&irradiance=1&sun-azimuth=-90&sun-elevation={}&apex={}&ior={}&abbe={}&"
                  "turn={}&height={}&slit=0.001&floor-size={}",
                  c.sun_elevation_deg, c.apex_deg, c.ior, c.abbe, turn, height, floor_size));
}

/// The strip of floor on which the beam of a given elevation lands, give or take some degrees.
inline PlaneView prismView(double expected_elevation, double height, double width) {
  PlaneView view;
  view.centre = vec3(static_cast<float>(height / std::tan(expected_elevation)), 0, 0);
  view.distance = 0.5 * height;
  view.width = width;
  view.columns = 2048;
  view.rows = static_cast<int>(0.12 / view.pixelSize());
  return view;
}

/// Centre of the light on the floor along X, m. Bands of wavelength may weigh negative in a channel, so each pixel
/// counts by what it has in all, whatever its sign.
inline double beamCentre(const PlanePicture& picture, int first_column, int last_column) {
  double sum = 0.0, moment = 0.0;
  std::vector<double> channels[3];
  for (int k = 0; k < 3; ++k) channels[k] = picture.columnMeans(k);
  for (int x = first_column; x < last_column; ++x) {
    double weight = 0.0;
    for (const auto& channel : channels) weight += std::abs(channel[static_cast<std::size_t>(x)]);
    sum += weight;
    moment += weight * (x + 0.5 - 0.5 * picture.view.columns) * picture.view.pixelSize();
  }
  return static_cast<double>(picture.view.centre.x) + moment / sum;
}

/// Lit stretches of the row, as [first, last) columns: each is a beam.
inline std::vector<std::pair<int, int>> findBeams(const PlanePicture& picture) {
  std::vector<double> total(static_cast<std::size_t>(picture.view.columns), 0.0);
  for (int k = 0; k < 3; ++k) {
    const std::vector<double> channel = picture.columnMeans(k);
    for (std::size_t x = 0; x < total.size(); ++x) total[x] += std::abs(channel[x]);
  }
  const double threshold = 0.05 * *std::max_element(total.begin(), total.end());
  std::vector<std::pair<int, int>> beams;
  for (int x = 0; x < picture.view.columns; ++x) {
    if (total[static_cast<std::size_t>(x)] < threshold) continue;
    if (beams.empty() || beams.back().second != x) beams.emplace_back(x, x);
    beams.back().second = x + 1;
  }
  return beams;
}

/// Deviation of each beam that the floor shows, rad, from the left. @param expected_elevation where to look
inline std::vector<double> measureDeviations(const PrismCase& c, double expected_elevation, std::uint64_t photons,
                                             const std::vector<std::string>& settings = {}) {
  constexpr double kLow = 0.3, kHigh = 0.6;
  std::vector<double> centres[2];
  for (const bool high : {false, true}) {
    const double height = high ? kHigh : kLow;
    const PlanePicture picture = renderPlane(
        makePrismScene(c, height), prismView(expected_elevation, height, 0.25 * height), photons, 1, settings);
    if (worstResidual(picture.ledgers) > 1e-5) return {};
    for (const auto& [first, last] : findBeams(picture))
      centres[high ? 1 : 0].push_back(beamCentre(picture, first, last));
  }
  std::vector<double> deviations;
  if (centres[0].size() != centres[1].size()) return deviations;
  for (std::size_t i = 0; i < centres[0].size(); ++i)
    deviations.push_back(std::atan2(kHigh - kLow, centres[1][i] - centres[0][i]) - radiansD(c.sun_elevation_deg));
  return deviations;
}

}  // namespace nephroid::closed_form
