// The white furnace: what is white cannot be told from the light around it.
//
// Let radiance L come from everywhere, and nothing absorb. A point of a convex white body scatters f(wi, wo) with
// ∫ f(wi, wo) cos θi dωi = 1 for every wo (reflection and, for glass, transmission together; inside glass radiance is n² L
// everywhere, and n² cancels on the way out). So it sends L to every wo, and a picture of it is L in every pixel: emission,
// scattering, absorption and all their normalisations checked at once, by one number.
//
// A horizontal surface gets E = ∫ L cos θ dω = π L over its hemisphere.
#pragma once

#include <fmt/format.h>

#include <memory>

#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"
#include "support/closed_form.h"
#include "support/closed_form_render.h"

namespace nephroid::closed_form {

inline constexpr float kFurnaceRadiance = 0.7F;

inline Environment makeFurnace() {
  Environment environment;
  environment.radiance = std::make_shared<const Image>(8, 4, 3, kFurnaceRadiance);
  environment.source = "constant";
  return environment;
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
  const RenderResult result = renderLayers(scene, scene.cameras[0], settings);
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
