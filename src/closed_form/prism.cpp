#include "closed_form/prism.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "closed_form/optics.h"
#include "scene/load.h"

namespace nephroid::closed_form {

double prismDeviation(double apex, double incidence, double ior) {
  const double inside = std::asin(std::sin(incidence) / ior);
  return incidence + std::asin(ior * std::sin(apex - inside)) - apex;
}

double prismMinimumDeviation(double apex, double ior) { return 2.0 * std::asin(ior * std::sin(0.5 * apex)) - apex; }

SceneData makePrismScene(const PrismCase& c, double height, double floor_size) {
  const double turn = c.incidence_deg - 0.5 * c.apex_deg + c.sun_elevation_deg;
  return loadScene(
      fmt::format("builtin:prism?light=sun&irradiance=1&sun-azimuth=-90&sun-elevation={}&apex={}&ior={}&abbe={}&"
                  "turn={}&height={}&slit=0.001&floor-size={}",
                  c.sun_elevation_deg, c.apex_deg, c.ior, c.abbe, turn, height, floor_size));
}

PlaneView prismView(double expected_elevation, double height, double width) {
  PlaneView view;
  view.centre = vec3(static_cast<float>(height / std::tan(expected_elevation)), 0, 0);
  view.distance = 0.5 * height;
  view.width = width;
  view.columns = 2048;
  view.rows = static_cast<int>(0.12 / view.pixelSize());
  return view;
}

double beamCentre(const PlanePicture& picture, int first_column, int last_column) {
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

std::vector<std::pair<int, int>> findBeams(const PlanePicture& picture) {
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

std::vector<double> measureDeviations(const PrismCase& c, double expected_elevation, std::uint64_t photons,
                                      const std::vector<std::string>& settings) {
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
