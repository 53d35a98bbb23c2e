#include "closed_form/ring.h"

#include <fmt/format.h>

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

}  // namespace nephroid::closed_form
