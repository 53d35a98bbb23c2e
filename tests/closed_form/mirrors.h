// Curved mirrors: the paraboloid, which has a focus, and the sphere, which has none.
//
// Paraboloid y = r²/(4f), light along −y. At r the normal is tilted by β, tan β = r/(2f), so the reflected ray is
// turned by 2β from +y towards the axis, and tan 2β = 2 tan β/(1 − tan² β) = r/(f − r²/(4f)): it passes through (0, f),
// for every r. All the light that the mirror takes up, less what the metal absorbs, is on a receiver of any size about
// the focus:
//
//   Φ = ∫ E⊥ ρ(cos β) dA⊥,   cos β = 1/√(1 + r²/(4f²)).
//
// Sphere of radius R about the origin, concave upwards, its lowest point at −R. At h the normal is tilted by α, sin α =
// h/R, the reflected ray makes 2α with +y. In the triangle of centre, mirror point and crossing the base angles are
// both α and the base is R, so it crosses the axis at the distance R/(2 cos α) below the centre:
//
//   s(h) = R − R/(2 cos α)  above the lowest point, R/2 for h → 0 (the paraxial focus), less farther out.
//
// On a plane at the height p above the lowest point the ring h lands at r(h) = (s − p) tan 2α (negative: beyond the
// axis).
#pragma once

#include <fmt/format.h>

#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"
#include "support/closed_form.h"
#include "support/closed_form_render.h"

namespace nephroid::closed_form {

struct ParaboloidCase {
  double focal_length = 1.0, reflectance = 0.8;
  double x0 = 0.2, x1 = 1.2, half_z = 0.5;  ///< an off-axis rectangle, so that the receiver shades nothing of it
  double receiver = 0.02;                   ///< side of the square receiver about the focus
};

inline double paraboloidFlux(const ParaboloidCase& c) {
  constexpr int kSteps = 400;
  const double dx = (c.x1 - c.x0) / kSteps, dz = 2.0 * c.half_z / kSteps;
  double flux = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double x = c.x0 + (i + 0.5) * dx, z = -c.half_z + (j + 0.5) * dz;
      const double cosine = 1.0 / std::sqrt(1.0 + (x * x + z * z) / (4.0 * c.focal_length * c.focal_length));
      flux += schlickReflectance(cosine, c.reflectance) * dx * dz;
    }
  }
  return flux;
}

inline SceneData makeParaboloidScene(const ParaboloidCase& c, int cells) {
  SceneData scene;
  const double middle = 0.5 * (c.x0 + c.x1), f = c.focal_length;
  Mesh mirror = makeHeightField("mirror", c.x1 - c.x0, 2.0 * c.half_z, cells, cells, [&](double x, double z) {
    const double from_axis = x + middle;
    return HeightSample{(from_axis * from_axis + z * z) / (4.0 * f), from_axis / (2.0 * f), z / (2.0 * f)};
  });
  for (vec3& position : mirror.positions) position.x += static_cast<float>(middle);
  addObject(scene, std::move(mirror), makeMirror("mirror", vec3(static_cast<float>(c.reflectance))));
  const double half = 0.5 * c.receiver;
  addObject(scene, makeRectangle("receiver", {0, f, 0}, {half, 0, 0}, {0, 0, half}),
            makeDiffuse("receiver", vec3(0.5F)));
  scene.lights.push_back(makeSun({0, -1, 0}));
  return scene;
}

/// The receiver's lower face.
inline PlaneView receiverView(double height, double width, int pixels) {
  PlaneView view;
  view.centre = vec3(0, static_cast<float>(height), 0);
  view.normal = vec3(0, -1, 0);
  view.up = vec3(0, 0, -1);
  view.distance = 0.5 * width;
  view.width = width;
  view.columns = view.rows = pixels;
  return view;
}

struct SphericalMirrorCase {
  double radius = 1.0, h0 = 0.03, h1 = 0.5;  ///< the zone from h0 to h1 about the axis
  double plane = 0.5;                        ///< of the receiver, above the lowest point
  double receiver_radius = 0.03;
};

inline double sphericalCrossing(double radius, double h) {
  return radius - radius / (2.0 * std::sqrt(1.0 - h * h / (radius * radius)));
}
inline double sphericalLanding(const SphericalMirrorCase& c, double h) {
  return (sphericalCrossing(c.radius, h) - c.plane) * std::tan(2.0 * std::asin(h / c.radius));
}

/// E / E⊥ in rings on the receiver, which shades the mirror's middle.
inline std::vector<double> sphericalIrradiance(const SphericalMirrorCase& c, std::size_t bins) {
  constexpr int kRings = 200'000;
  Profile profile(0.0, c.receiver_radius, bins);
  const double from = std::max(c.h0, c.receiver_radius), step = (c.h1 - from) / kRings;
  for (int i = 0; i < kRings; ++i) {
    const double h = from + i * step;
    profile.deposit(std::abs(sphericalLanding(c, h)), std::abs(sphericalLanding(c, h + step)),
                    2.0 * kPiD * (h + 0.5 * step) * step);
  }
  return profile.perAnnulus();
}

/// A perfect mirror: the zone of the sphere about (0, R, 0), facing up, and a round receiver above it.
inline SceneData makeSphericalMirrorScene(const SphericalMirrorCase& c, int rows, int segments) {
  SceneData scene;
  const double a0 = std::asin(c.h0 / c.radius), a1 = std::asin(c.h1 / c.radius);
  std::vector<ProfilePoint> profile;
  // Walked inwards, so that the reflecting side is on the right, where normals point.
  appendCurve(
      profile,
      [&](double a) {
        return ProfilePoint{
            {c.radius * std::sin(a), c.radius * (1.0 - std::cos(a))}, {-std::sin(a), std::cos(a)}, false};
      },
      a1, a0, rows);
  addObject(scene, makeRevolution("mirror", profile, segments), makeMirror("mirror", vec3(1.0F)));
  addObject(scene, makeDisc("receiver", {0, c.plane, 0}, c.receiver_radius, 256), makeDiffuse("receiver", vec3(0.5F)));
  scene.lights.push_back(makeSun({0, -1, 0}));
  return scene;
}

}  // namespace nephroid::closed_form
