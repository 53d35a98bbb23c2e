#include "scene/classify.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/material_texels.h"

namespace nephroid {
namespace {

/// Normal reflectance of a metal: of its complex index, or its base colour.
vec3 metalReflectance(const Material& material) {
  if (!material.conductor_ior) return vec3(material.base_color);
  const vec3 n = *material.conductor_ior, k2 = material.conductor_k * material.conductor_k;
  return ((n - 1.0F) * (n - 1.0F) + k2) / ((n + 1.0F) * (n + 1.0F) + k2);
}

/// Normal reflectance of the dielectric interface; of both faces together for a pane.
vec3 dielectricReflectance(const Material& material) {
  const float root = (material.ior - 1.0F) / (material.ior + 1.0F);
  float reflectance = root * root;
  if (material.transmits() && !material.isSolidDielectric()) reflectance = 2.0F * reflectance / (1.0F + reflectance);
  return glm::clamp(material.specular_factor * material.specular_color, 0.0F, 1.0F) * reflectance;
}

std::string describe(const Material& material, const Classification& c, float specular_alpha) {
  const bool solid = material.isSolidDielectric();
  const char* kind = material.metallic >= 0.5F ? "metal"
                     : solid                   ? "solid dielectric"
                     : material.transmits()    ? "thin pane"
                                               : "dielectric";
  std::string text =
      fmt::format("{}, alpha {:.3g} {} {:.3g}", kind, c.alpha, c.alpha < specular_alpha ? "<" : ">=", specular_alpha);
  if (c.specular_albedo > 0.0F)
    text += fmt::format(", specular albedo {:.3g} {} {:.3g}", c.specular_albedo,
                        c.specular_albedo > kGeneratorAlbedo ? ">" : "<=", kGeneratorAlbedo);
  if (c.specular_transmission > 0.0F) text += fmt::format(", specular transmission {:.3g}", c.specular_transmission);
  if (c.diffuse_albedo > 0.0F) text += fmt::format(", diffuse albedo {:.3g}", c.diffuse_albedo);
  return text;
}

/// The verdict without the sentence about it.
Classification judge(const Material& material, float specular_alpha) {
  Classification c;
  const float roughness = std::clamp(material.roughness, 0.0F, 1.0F);
  c.alpha = roughness * roughness;
  const bool specular = c.alpha < specular_alpha || c.alpha < kDeltaAlpha;
  const float metallic = std::clamp(material.metallic, 0.0F, 1.0F), dielectric = 1.0F - metallic;
  const float transmission = std::clamp(material.transmission, 0.0F, 1.0F);
  const vec3 base = glm::clamp(vec3(material.base_color), 0.0F, 1.0F);
  const vec3 weighted = glossOf(c.alpha, transmission) * dielectricReflectance(material);

  const float reflected =
      luminance(metallic * glm::clamp(metalReflectance(material), 0.0F, 1.0F) + dielectric * weighted);
  const float transmitted = luminance(dielectric * transmission * base * (1.0F - dielectricReflectance(material)));
  const float scattered = luminance(dielectric * (1.0F - transmission) * base * (1.0F - weighted));
  // Light goes straight through a smooth pane: that is no event, neither specular nor diffuse.
  const bool passes = !material.isSolidDielectric() && c.alpha < kDeltaAlpha;

  c.specular_albedo = specular ? reflected : 0.0F;
  c.specular_transmission = specular && !passes ? transmitted : 0.0F;
  c.diffuse_albedo = scattered + (specular ? 0.0F : reflected + transmitted);
  c.is_generator = c.specular_albedo > kGeneratorAlbedo || c.specular_transmission > 0.0F;
  c.is_weak_generator = !c.is_generator && c.specular_albedo > 0.0F;
  c.is_receiver = c.diffuse_albedo > 0.0F;
  return c;
}

}  // namespace

Classification classify(const Material& material, float specular_alpha) {
  Classification c = judge(material, specular_alpha);
  c.reason = describe(material, c, specular_alpha);
  return c;
}

Classification classify(const SceneData& scene, const Material& material, float specular_alpha) {
  if (!hasLobeTextures(material)) return classify(material, specular_alpha);
  Classification most;
  Material most_at;
  float diffuse_albedo = 0.0F, best = -1.0F;
  bool generator = false, weak = false, receiver = false;
  visitTexels(scene, material, [&](const Material& at) {
    const Classification c = judge(at, specular_alpha);
    generator = generator || c.is_generator;
    weak = weak || c.is_weak_generator;
    receiver = receiver || c.is_receiver;
    diffuse_albedo = std::max(diffuse_albedo, c.diffuse_albedo);
    const float specular = c.specular_albedo + c.specular_transmission;
    if (specular > best) best = specular, most = c, most_at = at;
  });
  most.diffuse_albedo = diffuse_albedo;
  most.is_generator = generator;
  most.is_weak_generator = weak && !generator;
  most.is_receiver = receiver;
  most.reason = describe(most_at, most, specular_alpha) + " (textured)";
  return most;
}

std::vector<Classification> classifyMaterials(const SceneData& scene, float specular_alpha) {
  std::vector<Classification> classes;
  for (const Material& material : scene.materials) classes.push_back(classify(scene, material, specular_alpha));
  return classes;
}

}  // namespace nephroid
