#include "trace/surface_material.h"

#include <algorithm>
#include <array>

#include "core/optics/fresnel.shared.h"
#include "core/optics/fresnel_average.h"
#include "scene/texture.h"

namespace nephroid {
namespace {

bool hasTextures(const Material& m) {
  return m.base_color_texture.valid() || m.metallic_roughness_texture.valid() || m.transmission_texture.valid() ||
         m.specular_texture.valid() || m.specular_color_texture.valid();
}

}  // namespace

float averageFresnel(float ior) {
  // 1024 steps over [1, 4] keep the linear interpolation's error below 1e-6; indices beyond are clamped.
  constexpr int kSteps = 1024;
  constexpr float kMaxIor = 4.0F;
  static const std::array<float, kSteps + 1> table = [] {
    std::array<float, kSteps + 1> t{};
    for (int i = 0; i <= kSteps; ++i) t[i] = averageFresnelDielectric(1.0F + (kMaxIor - 1.0F) * i / kSteps);
    return t;
  }();
  const bool inverted = ior < 1.0F;
  const float n = inverted ? 1.0F / std::max(ior, 1.0F / kMaxIor) : ior;
  const float x = std::min((n - 1.0F) / (kMaxIor - 1.0F), 1.0F) * kSteps;
  const int i = std::min(static_cast<int>(x), kSteps - 1);
  const float average = table[i] + (x - static_cast<float>(i)) * (table[i + 1] - table[i]);
  // Reciprocity of diffuse light: n_from² (1 − F_from→to) = n_to² (1 − F_to→from).
  return inverted ? 1.0F - (1.0F - average) / (n * n) : average;
}

MaterialTable::MaterialTable(const TraceScene& scene) : scene_(scene) {
  const SceneData& data = scene.scene();
  for (const Material& material : data.materials) {
    constant_.push_back(resolve(material, nullptr));
    sigma_a_per_m_.push_back(material.sigmaA());
    const bool cut = material.alpha_mode != AlphaMode::kOpaque;
    any_passable_ = any_passable_ || cut || constant_.back().is_pane;
  }
  for (const Instance& instance : data.instances) {
    const Mesh& mesh = data.meshes[instance.mesh];
    varies_.push_back(hasTextures(data.materials[mesh.material]) || !mesh.colors.empty());
  }
}

const SurfaceMaterial& MaterialTable::at(const SurfacePoint& point, SurfaceMaterial& scratch) const {
  if (!varies_[point.instance]) return constant_[scene_.materialIndexOf(point.instance)];
  scratch = resolve(scene_.materialOf(point.instance), &point);
  return scratch;
}

SurfaceMaterial MaterialTable::resolve(const Material& material, const SurfacePoint* point) const {
  const auto texel = [&](const TextureRef& reference, bool srgb) {
    if (!point || !reference.valid()) return vec4(1.0F);
    const vec2 uv = scene_.texcoordAt(point->instance, point->triangle, point->u, point->v, reference.texcoord);
    return sampleTexture(scene_.scene().images[reference.image], reference, uv, srgb);
  };
  vec4 base = material.base_color * texel(material.base_color_texture, true);
  if (point) base *= scene_.colorAt(point->instance, point->triangle, point->u, point->v);
  const vec4 metallic_roughness = texel(material.metallic_roughness_texture, false);
  SurfaceMaterial m;
  m.source = &material;
  m.base = glm::clamp(vec3(base), 0.0F, 1.0F);
  if (material.alpha_mode == AlphaMode::kMask) m.coverage = base.w >= material.alpha_cutoff ? 1.0F : 0.0F;
  if (material.alpha_mode == AlphaMode::kBlend) m.coverage = std::clamp(base.w, 0.0F, 1.0F);
  m.metallic = std::clamp(material.metallic * metallic_roughness.z, 0.0F, 1.0F);
  const float roughness = std::clamp(material.roughness * metallic_roughness.y, 0.0F, 1.0F);
  m.alpha = roughness * roughness;
  m.transmission = std::clamp(material.transmission * texel(material.transmission_texture, false).x, 0.0F, 1.0F);
  m.specular_tint = material.specular_factor * texel(material.specular_texture, false).w * material.specular_color *
                    vec3(texel(material.specular_color_texture, true));
  // A tint above 1 would reflect more than arrives.
  m.specular_tint = glm::clamp(m.specular_tint, 0.0F, 1.0F);
  m.gloss = glossOf(m.alpha, m.transmission);
  m.is_solid = material.isSolidDielectric();
  m.is_pane = material.transmits() && !m.is_solid && m.transmission > 0.0F;
  if (m.alpha < kDeltaAlpha) m.alpha = 0.0F;
  return m;
}

vec3 MaterialTable::emission(const SurfacePoint& point, bool outward) const {
  const Material& material = scene_.materialOf(point.instance);
  if (!material.emits() || (!outward && !material.double_sided)) return vec3(0.0F);
  if (!material.emission_texture.valid()) return material.emission;
  const TextureRef& reference = material.emission_texture;
  const vec2 uv = scene_.texcoordAt(point.instance, point.triangle, point.u, point.v, reference.texcoord);
  return material.emission * vec3(sampleTexture(scene_.scene().images[reference.image], reference, uv, true));
}

vec3 passTransmittance(const SurfaceMaterial& material, float cos_theta, float ior_outside) {
  vec3 pass(1.0F - material.coverage);
  if (material.is_pane && material.alpha == 0.0F) {
    const float r = fresnelThinPane(fresnelDielectric(cos_theta, ior_outside / material.source->ior));
    pass += material.coverage * (1.0F - material.metallic) * material.transmission * material.base *
            (1.0F - r * material.specular_tint);
  }
  return pass;
}

}  // namespace nephroid
