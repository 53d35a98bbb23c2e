#include "scene/import/gltf_materials.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/import/gltf_textures.h"
#include "scene/import/gltf_value.h"

namespace nephroid::gltf {
namespace {

/// Reads one material; keeps what all its parts need.
class MaterialReader {
 public:
  MaterialReader(Document& document, TextureReader& textures, const tinygltf::Material& source, std::size_t index)
      : document_(document), textures_(textures), source_(source), place_(placeOf("materials", index, source.name)) {
    out_.name = source.name.empty() ? placeOf("materials", index) : cleanName(source.name);
  }

  Material read() {
    readMetallicRoughness();
    readSurface();
    readEmission();
    readTransmission();
    readVolume();
    readSpecular();
    readUnlit();
    readExtras();
    return std::move(out_);
  }

 private:
  const tinygltf::Value& extension(const char* name) const { return getExtension(source_.extensions, name); }
  std::string at(std::string_view property) const { return fmt::format("{}.{}", place_, property); }

  float clamp(float value, float lower, float upper, std::string_view property) {
    const float clamped = std::clamp(value, lower, upper);
    if (clamped != value)
      document_.warn(at(property), upper < kInfinity
                                       ? fmt::format("{} is not in [{}, {}]; {} is used", value, lower, upper, clamped)
                                       : fmt::format("{} is below {}, which is used", value, lower));
    return clamped;
  }

  vec3 clamp(vec3 value, float lower, float upper, std::string_view property) {
    for (int c = 0; c < 3; ++c) value[c] = clamp(value[c], lower, upper, property);
    return value;
  }

  void readMetallicRoughness() {
    const tinygltf::PbrMetallicRoughness& pbr = source_.pbrMetallicRoughness;
    for (int c = 0; c < 4; ++c)
      out_.base_color[c] =
          clamp(static_cast<float>(pbr.baseColorFactor[static_cast<std::size_t>(c)]), 0, 1, "baseColorFactor");
    out_.metallic = clamp(static_cast<float>(pbr.metallicFactor), 0, 1, "metallicFactor");
    out_.roughness = clamp(static_cast<float>(pbr.roughnessFactor), 0, 1, "roughnessFactor");
    out_.base_color_texture = textures_.readInfo(pbr.baseColorTexture, at("baseColorTexture"));
    out_.metallic_roughness_texture = textures_.readInfo(pbr.metallicRoughnessTexture, at("metallicRoughnessTexture"));
  }

  void readSurface() {
    out_.normal_texture = textures_.readInfo(source_.normalTexture, at("normalTexture"));
    out_.normal_scale = static_cast<float>(source_.normalTexture.scale);
    out_.double_sided = source_.doubleSided;
    out_.alpha_cutoff = static_cast<float>(source_.alphaCutoff);
    if (source_.alphaMode == "MASK")
      out_.alpha_mode = AlphaMode::kMask;
    else if (source_.alphaMode == "BLEND")
      out_.alpha_mode = AlphaMode::kBlend;
    else if (source_.alphaMode != "OPAQUE")
      document_.warn(at("alphaMode"), fmt::format("'{}' is unknown; opaque", cleanName(source_.alphaMode)));
    if (source_.occlusionTexture.index >= 0)
      document_.warn(place_, "occlusionTexture is ignored: light transport occludes by itself");
  }

  void readEmission() {
    const auto& factor = source_.emissiveFactor;
    vec3 emission(0.0F);
    for (int c = 0; c < 3 && factor.size() == 3; ++c)
      emission[c] = static_cast<float>(factor[static_cast<std::size_t>(c)]);
    emission = clamp(emission, 0, kInfinity, "emissiveFactor");
    if (maxComponent(emission) > 1)
      document_.warn(
          at("emissiveFactor"),
          "is above 1, which glTF does not allow; accepted as it is (KHR_materials_emissive_strength is meant for it)");
    const float strength = getFloat(extension("KHR_materials_emissive_strength"), "emissiveStrength", 1.0F);
    out_.emission = emission * clamp(strength, 0, kInfinity, "emissiveStrength");
    if (!isFinite(out_.emission)) document_.fail(at("emissiveStrength"), "emissiveFactor times strength is not finite");
    out_.emission_texture = textures_.readInfo(source_.emissiveTexture, at("emissiveTexture"));
  }

  void readTransmission() {
    const tinygltf::Value& transmission = extension("KHR_materials_transmission");
    out_.transmission = clamp(getFloat(transmission, "transmissionFactor", 0), 0, 1, "transmissionFactor");
    out_.transmission_texture =
        textures_.read(getMember(transmission, "transmissionTexture"), at("transmissionTexture"));
    const float ior = getFloat(extension("KHR_materials_ior"), "ior", 1.5F);
    out_.ior = ior == 0 ? kInfiniteIor : clamp(ior, 1, kInfiniteIor, "ior");
    const tinygltf::Value& dispersion = extension("KHR_materials_dispersion");
    out_.dispersion = clamp(getFloat(dispersion, "dispersion", 0), 0, kInfinity, "dispersion");
  }

  void readVolume() {
    const tinygltf::Value& volume = extension("KHR_materials_volume");
    out_.thickness = clamp(getFloat(volume, "thicknessFactor", 0), 0, kInfinity, "thicknessFactor");
    if (isPresent(getMember(volume, "thicknessTexture")))
      document_.warn(at("thicknessTexture"), "is ignored: paths through the solid have their real length");
    out_.attenuation_color = clamp(getVec3(volume, "attenuationColor").value_or(vec3(1)), 0, 1, "attenuationColor");
    const float distance = getFloat(volume, "attenuationDistance", kInfinity);
    out_.attenuation_distance = distance;
    if (distance > 0) return;
    document_.warn(at("attenuationDistance"), fmt::format("{} is not above 0; nothing is absorbed", distance));
    out_.attenuation_distance = kInfinity;
  }

  void readSpecular() {
    const tinygltf::Value& specular = extension("KHR_materials_specular");
    out_.specular_factor = clamp(getFloat(specular, "specularFactor", 1), 0, 1, "specularFactor");
    const vec3 color = getVec3(specular, "specularColorFactor").value_or(vec3(1));
    out_.specular_color = clamp(color, 0, kInfinity, "specularColorFactor");
    out_.specular_texture = textures_.read(getMember(specular, "specularTexture"), at("specularTexture"));
    out_.specular_color_texture =
        textures_.read(getMember(specular, "specularColorTexture"), at("specularColorTexture"));
  }

  /// A surface that the file wants shown in its own colour whatever the light. In light transport there is no such
  /// thing; the nearest is a matt surface of that colour.
  void readUnlit() {
    if (!isPresent(extension("KHR_materials_unlit"))) return;
    document_.warn(place_, "KHR_materials_unlit is shown as a matt surface that light falls on");
    out_.metallic = 0;
    out_.roughness = 1;
    out_.transmission = 0;
    out_.specular_factor = 0;
    out_.metallic_roughness_texture = {};
    out_.normal_texture = {};
  }

  void readExtras() {
    const tinygltf::Value& extras = source_.extras;
    out_.priority = getInt(extras, "priority", 0);
    const auto ior = getVec3(extras, "eta");
    const auto k = getVec3(extras, "k");
    if (!ior && !k) return;
    if (!ior || !k || minComponent(*ior) <= 0 || minComponent(*k) < 0) {
      document_.warn(at("extras"),
                     "a conductor needs both eta (above 0) and k (not below 0), three numbers each; ignored");
      return;
    }
    out_.conductor_ior = *ior;
    out_.conductor_k = *k;
  }

  Document& document_;
  TextureReader& textures_;
  const tinygltf::Material& source_;
  std::string place_;
  Material out_;
};

}  // namespace

Material makeDefaultMaterial() {
  Material material;
  material.name = "default";
  material.metallic = 1.0F;
  material.roughness = 1.0F;
  return material;
}

void readMaterials(Document& document, SceneData& scene) {
  TextureReader textures(document, scene);
  for (std::size_t i = 0; i < document.model.materials.size(); ++i)
    scene.materials.push_back(MaterialReader(document, textures, document.model.materials[i], i).read());
}

}  // namespace nephroid::gltf
