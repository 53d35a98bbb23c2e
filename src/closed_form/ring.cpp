#include "closed_form/ring.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "closed_form/optics.h"
#include "scene/load.h"

namespace nephroid::closed_form {

dvec2 nephroidPoint(double radius, double phi) {
  return 0.25 * radius * dvec2(std::cos(3.0 * phi) - 3.0 * std::cos(phi), 3.0 * std::sin(phi) - std::sin(3.0 * phi));
}

RingLanding traceRing(const RingCase& c, double phi, double y) {
  const double elevation = radiansD(c.sun_elevation_deg), a = c.inner_radius, chord = 2.0 * a * std::cos(phi);
  const double kept = schlickReflectance(std::cos(elevation) * std::cos(phi), c.reflectance);
  double left = y / std::tan(elevation), share = kept, at = kPiD - phi, heading = -2.0 * phi;
  for (; left > chord; left -= chord) {
    // The chord from polar angle `at` along `heading` ends at 2·heading − at + π; there the heading turns by −(π −
    // 2|φ|) towards the side on which it runs along the wall: the same turn as from −X at the first hit.
    at = 2.0 * heading - at + kPiD;
    heading += kPiD - 2.0 * phi;
    share *= kept;
  }
  return {a * dvec2(std::cos(at), std::sin(at)) + left * dvec2(std::cos(heading), std::sin(heading)), share};
}

Image ringIrradiance(const RingCase& c, int pixels) {
  const int columns = 12 * pixels, levels = 6 * pixels;
  const double a = c.inner_radius, elevation = radiansD(c.sun_elevation_deg);
  std::vector<double> flux(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels), 0.0);
  for (int i = 0; i < columns; ++i) {
    const double phi = kPiD * ((i + 0.5) / columns - 0.5);
    const double patch = a * kPiD / columns * c.height / levels * std::cos(elevation) * std::cos(phi);
    for (int j = 0; j < levels; ++j) {
      const double y = c.height * (j + 0.5) / levels;
      if (y + 2.0 * a * std::cos(phi) * std::tan(elevation) < c.height) continue;
      const RingLanding landing = traceRing(c, phi, y);
      const int column = static_cast<int>((landing.position.x / a + 1.0) * 0.5 * pixels);
      const int row = static_cast<int>((landing.position.y / a + 1.0) * 0.5 * pixels);
      if (column < 0 || row < 0 || column >= pixels || row >= pixels) continue;
      flux[static_cast<std::size_t>(row) * static_cast<std::size_t>(pixels) + static_cast<std::size_t>(column)] +=
          patch * landing.share;
    }
  }
  const double area = 4.0 * a * a / pixels / pixels;
  Image image(pixels, pixels, 1);
  for (std::size_t i = 0; i < flux.size(); ++i) image.pixels[i] = static_cast<float>(flux[i] / area);
  return image;
}

SceneData makeRingScene(const RingCase& c, int segments) {
  return loadScene(
      fmt::format("builtin:ring?light=sun&irradiance=1&sun-azimuth=90&sun-elevation={}&radius={}&wall={}&height={}&"
                  "material=metal&color={},{},{}&segments={}",
                  c.sun_elevation_deg, c.inner_radius + c.wall, c.wall, c.height, c.reflectance, c.reflectance,
                  c.reflectance, segments));
}

PlaneView ringView(const RingCase& c, int pixels) {
  PlaneView view;
  view.distance = 0.1 * c.height;
  view.width = 2.0 * c.inner_radius;
  view.columns = view.rows = pixels;
  return view;
}

std::vector<double> sumSquares(const Image& image) {
  constexpr int kSide = 8;
  const int size = image.width / kSide;
  std::vector<double> sums;
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const double far_x = std::abs(column + 0.5 - 0.5 * size) + 0.5, far_y = std::abs(row + 0.5 - 0.5 * size) + 0.5;
      if (std::hypot(far_x, far_y) > 0.5 * size) continue;
      sums.push_back(0.0);
      for (int y = kSide * row; y < kSide * (row + 1); ++y)
        for (int x = kSide * column; x < kSide * (column + 1); ++x)
          sums.back() += static_cast<double>(image.at(x, y)[0]);
    }
  }
  return sums;
}

std::vector<double> axisProfile(const Image& image, int rows) {
  std::vector<double> profile(static_cast<std::size_t>(image.width), 0.0);
  for (int y = (image.height - rows) / 2; y < (image.height + rows) / 2; ++y)
    for (int x = 0; x < image.width; ++x)
      profile[static_cast<std::size_t>(x)] += static_cast<double>(image.at(x, y)[0]) / rows;
  return profile;
}

double nephroidDistance(const RingCase& c, const PlanePicture& picture) {
  const Image& image = picture.irradiance;
  const double pixel = picture.view.pixelSize();
  const int first_row = image.height / 2 + 92;
  double worst = 0.0;
  for (int column = 90; column <= 150; column += 2) {
    int brightest = first_row;
    for (int row = first_row; row < image.height; ++row)
      if (image.at(column, row)[0] > image.at(column, brightest)[0]) brightest = row;
    const dvec2 found((column + 0.5) * pixel - c.inner_radius, (brightest + 0.5) * pixel - c.inner_radius);
    double nearest = c.inner_radius;
    for (int i = 0; i <= 20'000; ++i)
      nearest = std::min(nearest, glm::length(found - nephroidPoint(c.inner_radius, 0.5 * kPiD * i / 20'000)));
    worst = std::max(worst, nearest);
  }
  return worst / pixel;
}

double cuspPosition(const RingCase& c, const PlanePicture& picture) {
  const double pixel = picture.view.pixelSize() / c.inner_radius;
  const std::vector<double> profile = axisProfile(picture.irradiance, 2);
  const auto peak = std::max_element(profile.begin(), profile.end()) - profile.begin();
  return (static_cast<double>(peak) + 0.5) * pixel - 1.0 + 0.75 * std::pow(pixel, 2.0 / 3.0);
}

}  // namespace nephroid::closed_form
