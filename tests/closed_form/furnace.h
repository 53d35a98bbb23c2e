// The white furnace: what is white cannot be told from the light around it.
//
// Let radiance L come from everywhere, and nothing absorb. A point of a convex white body scatters f(wi, wo) with
// ∫ f(wi, wo) cos θi dωi = 1 for every wo (reflection and, for glass, transmission together; inside glass radiance is
// n² L everywhere, and n² cancels on the way out). So it sends L to every wo, and a picture of it is L in every pixel:
// emission, scattering, absorption and all their normalisations checked at once, by one number.
//
// A rough metal of one scattering event is white but for the light that would meet a second microfacet: it shows
// L times the directional albedo of its microfacets,
//
//   a(wo) = ∫ D(h) G2(wo, wi) / (4 cos θo) dωi = ∫ D(h) G2(wo, wi) (wo·h) / cos θo dωh,   wi = 2 (wo·h) h − wo,
//
// over all h with wi above the surface: GGX, D = α² / (π (cos²θh (α² − 1) + 1)²), and Smith's height-correlated
// G2 = 1/(1 + Λ(wo) + Λ(wi)), Λ = (√(1 + α² tan²θ) − 1)/2.
//
// A horizontal surface gets E = ∫ L cos θ dω = π L over its hemisphere.
#pragma once

#include <fmt/format.h>

#include <memory>

#include "closed_form/optics.h"
#include "closed_form/plane_picture.h"
#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"

namespace nephroid::closed_form {

inline constexpr float kFurnaceRadiance = 0.7F;

inline Environment makeFurnace() {
  Environment environment;
  environment.radiance = std::make_shared<const Image>(8, 4, 3, kFurnaceRadiance);
  environment.source = "constant";
  return environment;
}

/// a(wo) by the midpoint rule. Polar angles of h are spaced as their slopes' distribution, tan θh = α √(u/(1 − u)), for
/// which D cos θh dωh = du dφ/2π.
inline double microfacetAlbedo(double cos_o, double alpha) {
  constexpr int kPolar = 1500, kAround = 720;
  const auto lambda = [&](double cosine) {
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 / (cosine * cosine) - 1.0)) - 1.0);
  };
  const dvec3 wo(std::sqrt(1.0 - cos_o * cos_o), 0.0, cos_o);
  double sum = 0.0;
  for (int i = 0; i < kPolar; ++i) {
    const double u = (i + 0.5) / kPolar, slope = alpha * std::sqrt(u / (1.0 - u));
    const double cos_h = 1.0 / std::sqrt(1.0 + slope * slope), sin_h = slope * cos_h;
    for (int j = 0; j < kAround; ++j) {
      const double phi = 2.0 * kPiD * (j + 0.5) / kAround;
      const dvec3 h(sin_h * std::cos(phi), sin_h * std::sin(phi), cos_h);
      const double wo_h = glm::dot(wo, h), cos_i = 2.0 * wo_h * cos_h - cos_o;
      if (wo_h <= 0.0 || cos_i <= 0.0) continue;
      sum += wo_h / (cos_o * cos_h * (1.0 + lambda(cos_o) + lambda(cos_i)));
    }
  }
  return sum / (static_cast<double>(kPolar) * kAround);
}

/// One body that fills most of the picture.
inline SceneData makeFurnaceScene(Mesh mesh, const Material& material) {
  SceneData scene;
  addObject(scene, std::move(mesh), material);
  scene.environment = makeFurnace();
  addCamera(scene, {1.2F, 1.0F, 2.6F}, {0, 0, 0}, 38);
  return scene;
}

inline Material makeWhiteGlass(float roughness) {
  Material glass = makeDiffuse("glass", vec3(1.0F));
  glass.roughness = roughness;
  glass.specular_factor = 1.0F;
  glass.transmission = 1.0F;
  glass.thickness = 1.0F;
  return glass;
}

/// A white base under a smooth clear coat.
inline Material makeVarnish() {
  Material varnish = makeDiffuse("varnish", vec3(1.0F));
  varnish.roughness = 0.0F;
  varnish.specular_factor = 1.0F;
  return varnish;
}

/// Picture statistics of beauty / L.
struct FurnaceResult {
  double mean = 0, lowest = 0, highest = 0;
};
inline FurnaceResult burn(const SceneData& scene, std::uint64_t samples, int size = 48, const char* layer = "beauty") {
  RenderSettings settings;
  settings.width = settings.height = size;
  settings.layers = {layer};
  settings.samples = samples;
  settings.photons = samples * 4096;
  settings.seed = 1;
  const Technique& reference = findTechnique("reference");
  settings.params = ParamSet(reference.params);
  const RenderResult result = reference.render(scene, scene.cameras[0], settings, nullptr, nullptr);
  const Image& image = *result.image.find(layer);
  FurnaceResult out{0.0, 1e30, -1e30};
  for (const float value : image.pixels) {
    const double relative = static_cast<double>(value) / static_cast<double>(kFurnaceRadiance);
    out.mean += relative / static_cast<double>(image.pixels.size());
    out.lowest = std::min(out.lowest, relative);
    out.highest = std::max(out.highest, relative);
  }
  return out;
}

}  // namespace nephroid::closed_form
