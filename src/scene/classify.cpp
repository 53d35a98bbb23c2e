#include "scene/classify.h"

#include <fmt/format.h>

#include <algorithm>

namespace nephroid {
namespace {

/// Below this width a lobe is a mirror in single precision; a pane that smooth lets light straight through.
constexpr float kSmoothAlpha = 5e-4F;

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

/// Weight of the dielectric lobe: 1 up to the default bound of specular lobes, falling to 0 at alpha 1 (a fully rough
/// dielectric is exactly Lambertian), but 1 for what transmits.
float dielectricWeight(float alpha, float transmission) {
  const float faded = std::clamp((1.0F - alpha) / (1.0F - kDefaultSpecularAlpha), 0.0F, 1.0F);
  return transmission + (1.0F - transmission) * faded;
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

}  // namespace

Classification classify(const Material& material, float specular_alpha) {
  Classification c;
  const float roughness = std::clamp(material.roughness, 0.0F, 1.0F);
  c.alpha = roughness * roughness;
  const bool specular = c.alpha < specular_alpha || c.alpha < kSmoothAlpha;
  const float metallic = std::clamp(material.metallic, 0.0F, 1.0F), dielectric = 1.0F - metallic;
  const float transmission = std::clamp(material.transmission, 0.0F, 1.0F);
  const vec3 base = glm::clamp(vec3(material.base_color), 0.0F, 1.0F);
  const vec3 weighted = dielectricWeight(c.alpha, transmission) * dielectricReflectance(material);

  const float reflected =
      luminance(metallic * glm::clamp(metalReflectance(material), 0.0F, 1.0F) + dielectric * weighted);
  const float transmitted = luminance(dielectric * transmission * base * (1.0F - dielectricReflectance(material)));
  const float scattered = luminance(dielectric * (1.0F - transmission) * base * (1.0F - weighted));
  // Light goes straight through a smooth pane: that is no event, neither specular nor diffuse.
  const bool passes = !material.isSolidDielectric() && c.alpha < kSmoothAlpha;

  c.specular_albedo = specular ? reflected : 0.0F;
  c.specular_transmission = specular && !passes ? transmitted : 0.0F;
  c.diffuse_albedo = scattered + (specular ? 0.0F : reflected + transmitted);
  c.is_generator = c.specular_albedo > kGeneratorAlbedo || c.specular_transmission > 0.0F;
  c.is_weak_generator = !c.is_generator && c.specular_albedo > 0.0F;
  c.is_receiver = c.diffuse_albedo > 0.0F;
  c.reason = describe(material, c, specular_alpha);
  return c;
}

}  // namespace nephroid
