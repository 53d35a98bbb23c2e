#include "closed_form/prism.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "closed_form/optics.h"
#include "core/spectrum.h"
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

std::vector<double> measureDeviations(const PrismCase& c, double expected_elevation, const PlaneRenderer& render,
                                      const std::vector<std::string>& parameters) {
  constexpr double kLow = 0.3, kHigh = 0.6;
  std::vector<double> centres[2];
  for (const bool high : {false, true}) {
    const double height = high ? kHigh : kLow;
    const PlanePicture picture =
        render(makePrismScene(c, height), prismView(expected_elevation, height, 0.25 * height), parameters);
    for (const auto& [first, last] : findBeams(picture))
      centres[high ? 1 : 0].push_back(beamCentre(picture, first, last));
  }
  std::vector<double> deviations;
  if (centres[0].size() != centres[1].size()) return deviations;
  for (std::size_t i = 0; i < centres[0].size(); ++i)
    deviations.push_back(std::atan2(kHigh - kLow, centres[1][i] - centres[0][i]) - radiansD(c.sun_elevation_deg));
  return deviations;
}

PrismCase FanCase::prism() const {
  PrismCase c{.ior = 1.62, .abbe = 30.0};
  c.incidence_deg = 0.5 * (c.apex_deg + degreesD(prismMinimumDeviation(radiansD(c.apex_deg), c.ior)));
  return c;
}

SceneData FanCase::scene() const { return makePrismScene(prism(), height, 40.0); }

PlaneView FanCase::view() const {
  const PrismCase c = prism();
  return prismView(radiansD(c.sun_elevation_deg) + prismMinimumDeviation(radiansD(c.apex_deg), c.ior), height, width);
}

std::vector<dvec3> fanIrradiance(const FanCase& fan) {
  constexpr int kWavelengths = 20000;
  const PrismCase c = fan.prism();
  const double apex = radiansD(c.apex_deg), incidence = radiansD(c.incidence_deg);
  const double centre = static_cast<double>(fan.view().centre.x);
  std::vector<dvec3> irradiance(fan.bins, dvec3(0.0));
  for (int i = 0; i < kWavelengths; ++i) {
    const float nm = kWavelengthMin_nm + (kWavelengthMax_nm - kWavelengthMin_nm) * (static_cast<float>(i) + 0.5F) /
                                             static_cast<float>(kWavelengths);
    const double ior = cauchyIndex(c.ior, c.abbe, static_cast<double>(nm));
    const double inside = std::asin(std::sin(incidence) / ior);
    const double kept = (1.0 - fresnelReflectance(std::cos(incidence), 1.0, ior)) *
                        (1.0 - fresnelReflectance(std::cos(apex - inside), ior, 1.0));
    const double elevation = radiansD(c.sun_elevation_deg) + prismDeviation(apex, incidence, ior);
    const double x = fan.height / std::tan(elevation) - centre;
    const double bin = (x / fan.width + 0.5) * static_cast<double>(fan.bins);
    if (bin >= 0.0 && bin < static_cast<double>(fan.bins))
      irradiance[static_cast<std::size_t>(bin)] += kept * dvec3(wavelengthRgb(nm));
  }
  return irradiance;
}

std::vector<dvec3> binColumns(const PlanePicture& picture, std::size_t bins) {
  std::vector<dvec3> sums(bins, dvec3(0.0));
  for (int k = 0; k < 3; ++k) {
    const std::vector<double> means = picture.columnMeans(k);
    for (std::size_t x = 0; x < means.size(); ++x) sums[x * bins / means.size()][k] += means[x];
  }
  return sums;
}

double relativeColourL1(const std::vector<dvec3>& measured, const std::vector<dvec3>& predicted) {
  double sum_measured = 0.0, sum_predicted = 0.0, difference = 0.0, size = 0.0;
  for (const dvec3& v : measured) sum_measured += v.x + v.y + v.z;
  for (const dvec3& v : predicted) sum_predicted += v.x + v.y + v.z;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const dvec3 p = predicted[i] / sum_predicted, d = glm::abs(measured[i] / sum_measured - p);
    difference += d.x + d.y + d.z;
    size += std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
  }
  return difference / size;
}

}  // namespace nephroid::closed_form
