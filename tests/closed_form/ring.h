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

#include <fmt/format.h>

#include "core/image/image.h"
#include "scene/load.h"
#include "support/closed_form.h"
#include "support/closed_form_render.h"

namespace nephroid::closed_form {

struct RingCase {
  double inner_radius = 0.048, wall = 0.002, height = 0.03;
  double sun_elevation_deg = 45.0, reflectance = 0.9;
};

/// A point of the caustic curve.
inline dvec2 nephroidPoint(double radius, double phi) {
  return 0.25 * radius * dvec2(std::cos(3.0 * phi) - 3.0 * std::cos(phi), 3.0 * std::sin(phi) - std::sin(3.0 * phi));
}

/// Where a ray that meets the wall at (φ, y) ends on the floor (x, z), and the share of its flux that is left.
struct RingLanding {
  dvec2 position{0};
  double share = 0;
};
inline RingLanding traceRing(const RingCase& c, double phi, double y) {
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

/// E / E⊥ on `pixels`² squares of [−a, a]²: x to the right, z downwards (towards the viewer); a picture of one channel.
inline Image ringIrradiance(const RingCase& c, int pixels) {
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

inline SceneData makeRingScene(const RingCase& c, int segments) {
  return loadScene(
      fmt::format("builtin:ring?light=sun&irradiance=1&sun-azimuth=90&sun-elevation={}&radius={}&wall={}&height={}&"
                  "material=metal&color={},{},{}&segments={}",
                  c.sun_elevation_deg, c.inner_radius + c.wall, c.wall, c.height, c.reflectance, c.reflectance,
                  c.reflectance, segments));
}

/// The inside of the ring, seen from below its rim.
inline PlaneView ringView(const RingCase& c, int pixels) {
  PlaneView view;
  view.distance = 0.1 * c.height;
  view.width = 2.0 * c.inner_radius;
  view.columns = view.rows = pixels;
  return view;
}

}  // namespace nephroid::closed_form
