#include "closed_form/mirrors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "closed_form/optics.h"
#include "closed_form/profile.h"
#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"

namespace nephroid::closed_form {

double paraboloidFlux(const ParaboloidCase& c) {
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

SceneData makeParaboloidScene(const ParaboloidCase& c, int cells) {
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

PlaneView receiverView(double height, double width, int pixels) {
  PlaneView view;
  view.centre = vec3(0, static_cast<float>(height), 0);
  view.normal = vec3(0, -1, 0);
  view.up = vec3(0, 0, -1);
  view.distance = 0.5 * width;
  view.width = width;
  view.columns = view.rows = pixels;
  return view;
}

double sphericalCrossing(double radius, double h) {
  return radius - radius / (2.0 * std::sqrt(1.0 - h * h / (radius * radius)));
}

double sphericalLanding(const SphericalMirrorCase& c, double h) {
  return (sphericalCrossing(c.radius, h) - c.plane) * std::tan(2.0 * std::asin(h / c.radius));
}

std::vector<double> sphericalIrradiance(const SphericalMirrorCase& c, std::size_t bins) {
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

SceneData makeSphericalMirrorScene(const SphericalMirrorCase& c, int rows, int segments) {
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

double measureCrossing(double h, const PlaneRenderer& render) {
  constexpr double kPlanes[2] = {0.30, 0.38};
  double radii[2];
  for (int i = 0; i < 2; ++i) {
    SphericalMirrorCase c{.h0 = h - 0.002, .h1 = h + 0.002, .plane = kPlanes[i], .receiver_radius = 0.2};
    // Receivers wider than the zone would shade it: as wide as the light on them, and some.
    c.receiver_radius = std::min(1.2 * sphericalLanding(c, h), 0.95 * h);
    const PlaneView view = receiverView(c.plane, 2.0 * c.receiver_radius, 512);
    radii[i] = render(makeSphericalMirrorScene(c, 8, 1024), view, {}).meanRadius();
  }
  return kPlanes[0] + (kPlanes[1] - kPlanes[0]) * radii[0] / (radii[0] - radii[1]);
}

}  // namespace nephroid::closed_form
