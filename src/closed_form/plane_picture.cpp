#include "closed_form/plane_picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace nephroid::closed_form {
namespace {

/// Parts of a pixel along each side, to tell how much of it lies in which ring,
constexpr int kMostParts = 8;
/// if rings are at least so many pixels wide: narrower ones it would only blur.
constexpr double kWideRing = 2.0;

}  // namespace

Camera PlaneView::camera() const {
  Camera camera;
  camera.name = "closed form";
  camera.eye = centre + static_cast<float>(distance) * normal;
  camera.forward = -normal;
  camera.up = up;
  camera.ortho_height = static_cast<float>(height());
  return camera;
}

dvec3 PlanePicture::flux() const {
  dvec3 sum(0.0);
  for (int y = 0; y < irradiance.height; ++y)
    for (int x = 0; x < irradiance.width; ++x) sum += dvec3(irradiance.rgb(x, y));
  return sum * (view.pixelSize() * view.pixelSize());
}

std::vector<double> PlanePicture::columnMeans(int channel) const {
  std::vector<double> means(static_cast<std::size_t>(irradiance.width), 0.0);
  for (int y = 0; y < irradiance.height; ++y)
    for (int x = 0; x < irradiance.width; ++x)
      means[static_cast<std::size_t>(x)] += static_cast<double>(irradiance.at(x, y)[channel]) / irradiance.height;
  return means;
}

std::vector<double> PlanePicture::rowMeans(int channel) const {
  std::vector<double> means(static_cast<std::size_t>(irradiance.height), 0.0);
  for (int y = 0; y < irradiance.height; ++y)
    for (int x = 0; x < irradiance.width; ++x)
      means[static_cast<std::size_t>(y)] += static_cast<double>(irradiance.at(x, y)[channel]) / irradiance.width;
  return means;
}

bool PlanePicture::isBlack() const {
  return std::all_of(irradiance.pixels.begin(), irradiance.pixels.end(), [](float value) { return value == 0.0F; });
}

double PlanePicture::meanRadius(int channel) const {
  double sum = 0.0, moment = 0.0;
  for (int y = 0; y < irradiance.height; ++y) {
    for (int x = 0; x < irradiance.width; ++x) {
      const double value = static_cast<double>(irradiance.at(x, y)[channel]);
      sum += value;
      moment += value * std::hypot(x + 0.5 - 0.5 * irradiance.width, y + 0.5 - 0.5 * irradiance.height);
    }
  }
  return moment / sum * view.pixelSize();
}

std::vector<double> PlanePicture::ringMeans(double radius, std::size_t rings, int channel) const {
  std::vector<double> sums(rings, 0.0), counts(rings, 0.0);
  const bool are_wide = radius / static_cast<double>(rings) >= kWideRing * view.pixelSize();
  const int parts = are_wide ? kMostParts : 1;
  for (int y = 0; y < irradiance.height; ++y) {
    for (int x = 0; x < irradiance.width; ++x) {
      // A pixel that lies across a circle counts on both sides of it, by area.
      for (int k = 0; k < parts * parts; ++k) {
        const double dx = x + (k % parts + 0.5) / parts - 0.5 * irradiance.width,
                     dy = y + (k / parts + 0.5) / parts - 0.5 * irradiance.height;
        const double ring = std::hypot(dx, dy) * view.pixelSize() / radius * static_cast<double>(rings);
        if (ring >= static_cast<double>(rings)) continue;
        sums[static_cast<std::size_t>(ring)] += static_cast<double>(irradiance.at(x, y)[channel]);
        counts[static_cast<std::size_t>(ring)] += 1.0;
      }
    }
  }
  for (std::size_t i = 0; i < rings; ++i) sums[i] /= std::max(counts[i], 1.0);
  return sums;
}

PlanePicture renderPlane(const SceneData& scene, const PlaneView& view, PlaneRender render) {
  const Technique& technique = findTechnique(render.technique);
  RenderSettings& settings = render.settings;
  settings.width = view.columns, settings.height = view.rows;
  settings.layers = {"irradiance_caustic"};
  if (settings.params.specs().empty()) settings.params = ParamSet(technique.params);
  for (const std::string& parameter : render.parameters) {
    const std::size_t mark = parameter.find('=');
    settings.params.set(parameter.substr(0, mark), parameter.substr(mark + 1));
  }
  RenderResult result = technique.render(scene, view.camera(), settings, render.progress, render.stop);
  return {view, *result.image.find("irradiance_caustic"), std::move(result.ledgers), std::move(result.stats)};
}

PlanePicture renderPlane(const SceneData& scene, const PlaneView& view, std::uint64_t photons, std::uint64_t seed,
                         const std::vector<std::string>& parameters) {
  PlaneRender render;
  render.parameters = parameters;
  render.settings.photons = photons;
  render.settings.seed = seed;
  return renderPlane(scene, view, std::move(render));
}

double worstResidual(const std::vector<Ledger>& ledgers) {
  double worst = ledgers.empty() ? 1.0 : 0.0;
  for (const Ledger& ledger : ledgers) worst = std::max(worst, std::abs(ledger.residual()));
  return worst;
}

Light makeSun(vec3 dir, float angle_deg) {
  Light sun;
  sun.name = "sun";
  sun.kind = LightKind::kSun;
  sun.direction = dir;
  sun.intensity = vec3(1.0F);
  sun.angle_deg = angle_deg;
  return sun;
}

}  // namespace nephroid::closed_form
