#include "scene/import/gltf_schema.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "nephroid/error.h"
#include "scene/import/text.h"

namespace nephroid::gltf {
namespace {

using nlohmann::json;

enum class Type {
  kIndex,    ///< integer in [0, 2³¹)
  kSize,     ///< integer in [0, 2⁵³]: byte counts and offsets
  kNumber,   ///< finite as float
  kNumbers,  ///< array of `length` such numbers (0: any length)
  kIndices,  ///< array of indices
  kString,
  kStrings,
  kBool,
  kObject,
  kTexture,  ///< textureInfo
};

/// `path`: names joined by '.', "[]" after an array's name, "*" for every member of an object.
struct Rule {
  std::string_view path;
  Type type;
  std::size_t length = 0;
};

// In the order of the specification's chapters, extensions with their hosts.
constexpr Rule kRules[] = {
    {"asset", Type::kObject},
    {"asset.version", Type::kString},
    {"asset.minVersion", Type::kString},
    {"extensionsUsed", Type::kStrings},
    {"extensionsRequired", Type::kStrings},
    {"scene", Type::kIndex},
    {"scenes[].name", Type::kString},
    {"scenes[].nodes", Type::kIndices},
    {"nodes[].name", Type::kString},
    {"nodes[].children", Type::kIndices},
    {"nodes[].camera", Type::kIndex},
    {"nodes[].mesh", Type::kIndex},
    {"nodes[].skin", Type::kIndex},
    {"nodes[].matrix", Type::kNumbers, 16},
    {"nodes[].translation", Type::kNumbers, 3},
    {"nodes[].rotation", Type::kNumbers, 4},
    {"nodes[].scale", Type::kNumbers, 3},
    {"nodes[].extensions.KHR_lights_punctual.light", Type::kIndex},
    {"nodes[].extensions.EXT_mesh_gpu_instancing.attributes.*", Type::kIndex},
    {"buffers[].uri", Type::kString},
    {"buffers[].byteLength", Type::kSize},
    {"bufferViews[].buffer", Type::kIndex},
    {"bufferViews[].byteOffset", Type::kSize},
    {"bufferViews[].byteLength", Type::kSize},
    {"bufferViews[].byteStride", Type::kIndex},
    {"bufferViews[].extensions.EXT_meshopt_compression.buffer", Type::kIndex},
    {"bufferViews[].extensions.EXT_meshopt_compression.byteOffset", Type::kIndex},
    {"bufferViews[].extensions.EXT_meshopt_compression.byteLength", Type::kIndex},
    {"bufferViews[].extensions.EXT_meshopt_compression.byteStride", Type::kIndex},
    {"bufferViews[].extensions.EXT_meshopt_compression.count", Type::kIndex},
    {"bufferViews[].extensions.EXT_meshopt_compression.mode", Type::kString},
    {"bufferViews[].extensions.EXT_meshopt_compression.filter", Type::kString},
    {"accessors[].bufferView", Type::kIndex},
    {"accessors[].byteOffset", Type::kSize},
    {"accessors[].componentType", Type::kIndex},
    {"accessors[].normalized", Type::kBool},
    {"accessors[].count", Type::kSize},
    {"accessors[].type", Type::kString},
    {"accessors[].sparse", Type::kObject},
    {"accessors[].sparse.count", Type::kIndex},
    {"accessors[].sparse.indices", Type::kObject},
    {"accessors[].sparse.indices.bufferView", Type::kIndex},
    {"accessors[].sparse.indices.byteOffset", Type::kIndex},
    {"accessors[].sparse.indices.componentType", Type::kIndex},
    {"accessors[].sparse.values", Type::kObject},
    {"accessors[].sparse.values.bufferView", Type::kIndex},
    {"accessors[].sparse.values.byteOffset", Type::kIndex},
    {"meshes[].name", Type::kString},
    {"meshes[].primitives[].attributes.*", Type::kIndex},
    {"meshes[].primitives[].indices", Type::kIndex},
    {"meshes[].primitives[].material", Type::kIndex},
    {"meshes[].primitives[].mode", Type::kIndex},
    {"meshes[].primitives[].extensions.KHR_draco_mesh_compression.bufferView", Type::kIndex},
    {"meshes[].primitives[].extensions.KHR_draco_mesh_compression.attributes.*", Type::kIndex},
    {"images[].uri", Type::kString},
    {"images[].bufferView", Type::kIndex},
    {"images[].mimeType", Type::kString},
    {"images[].name", Type::kString},
    {"samplers[].magFilter", Type::kIndex},
    {"samplers[].minFilter", Type::kIndex},
    {"samplers[].wrapS", Type::kIndex},
    {"samplers[].wrapT", Type::kIndex},
    {"textures[].sampler", Type::kIndex},
    {"textures[].source", Type::kIndex},
    {"textures[].extensions.KHR_texture_basisu.source", Type::kIndex},
    {"textures[].extensions.EXT_texture_webp.source", Type::kIndex},
    {"materials[].name", Type::kString},
    {"materials[].pbrMetallicRoughness.baseColorFactor", Type::kNumbers, 4},
    {"materials[].pbrMetallicRoughness.baseColorTexture", Type::kTexture},
    {"materials[].pbrMetallicRoughness.metallicFactor", Type::kNumber},
    {"materials[].pbrMetallicRoughness.roughnessFactor", Type::kNumber},
    {"materials[].pbrMetallicRoughness.metallicRoughnessTexture", Type::kTexture},
    {"materials[].normalTexture", Type::kTexture},
    {"materials[].normalTexture.scale", Type::kNumber},
    {"materials[].occlusionTexture", Type::kTexture},
    {"materials[].emissiveTexture", Type::kTexture},
    {"materials[].emissiveFactor", Type::kNumbers, 3},
    {"materials[].alphaMode", Type::kString},
    {"materials[].alphaCutoff", Type::kNumber},
    {"materials[].doubleSided", Type::kBool},
    {"materials[].extensions.KHR_materials_transmission.transmissionFactor", Type::kNumber},
    {"materials[].extensions.KHR_materials_transmission.transmissionTexture", Type::kTexture},
    {"materials[].extensions.KHR_materials_ior.ior", Type::kNumber},
    {"materials[].extensions.KHR_materials_volume.thicknessFactor", Type::kNumber},
    {"materials[].extensions.KHR_materials_volume.attenuationDistance", Type::kNumber},
    {"materials[].extensions.KHR_materials_volume.attenuationColor", Type::kNumbers, 3},
    {"materials[].extensions.KHR_materials_dispersion.dispersion", Type::kNumber},
    {"materials[].extensions.KHR_materials_emissive_strength.emissiveStrength", Type::kNumber},
    {"materials[].extensions.KHR_materials_specular.specularFactor", Type::kNumber},
    {"materials[].extensions.KHR_materials_specular.specularTexture", Type::kTexture},
    {"materials[].extensions.KHR_materials_specular.specularColorFactor", Type::kNumbers, 3},
    {"materials[].extensions.KHR_materials_specular.specularColorTexture", Type::kTexture},
    {"cameras[].name", Type::kString},
    {"cameras[].type", Type::kString},
    {"cameras[].perspective", Type::kObject},
    {"cameras[].perspective.yfov", Type::kNumber},
    {"cameras[].orthographic", Type::kObject},
    {"cameras[].orthographic.xmag", Type::kNumber},
    {"cameras[].orthographic.ymag", Type::kNumber},
    {"animations[].name", Type::kString},
    {"animations[].channels[].sampler", Type::kIndex},
    {"animations[].channels[].target", Type::kObject},
    {"animations[].channels[].target.node", Type::kIndex},
    {"animations[].channels[].target.path", Type::kString},
    {"animations[].samplers[].input", Type::kIndex},
    {"animations[].samplers[].output", Type::kIndex},
    {"animations[].samplers[].interpolation", Type::kString},
    {"extensions.KHR_lights_punctual.lights[].name", Type::kString},
    {"extensions.KHR_lights_punctual.lights[].type", Type::kString},
    {"extensions.KHR_lights_punctual.lights[].color", Type::kNumbers, 3},
    {"extensions.KHR_lights_punctual.lights[].intensity", Type::kNumber},
    {"extensions.KHR_lights_punctual.lights[].spot.innerConeAngle", Type::kNumber},
    {"extensions.KHR_lights_punctual.lights[].spot.outerConeAngle", Type::kNumber},
};

constexpr Rule kTextureRules[] = {
    {"index", Type::kIndex},
    {"texCoord", Type::kIndex},
    {"extensions.KHR_texture_transform.offset", Type::kNumbers, 2},
    {"extensions.KHR_texture_transform.scale", Type::kNumbers, 2},
    {"extensions.KHR_texture_transform.rotation", Type::kNumber},
    {"extensions.KHR_texture_transform.texCoord", Type::kIndex},
};

/// The way from the root to a value, kept on the stack: it becomes text only when something is wrong.
struct Place {
  const Place* parent = nullptr;
  std::string_view name;
  std::size_t index = 0;
  bool is_element = false;

  std::string text() const {
    const std::string before = parent != nullptr ? parent->text() : "";
    if (is_element) return fmt::format("{}[{}]", before, index);
    return before.empty() ? cleanName(name) : before + "." + cleanName(name);
  }
};

class TypeChecker {
 public:
  explicit TypeChecker(const std::filesystem::path& path) : path_(path) {}

  /// Follows `rest` of a rule's path from `value` to wherever it leads and checks what is there.
  void visit(json& value, std::string_view rest, const Rule& rule, const Place& place) const {
    if (rest.empty()) return check(value, rule, place);
    if (!value.is_object()) fail(place, value, "an object");
    const std::size_t dot = rest.find('.');
    std::string_view name = rest.substr(0, dot);
    const std::string_view after = dot == std::string_view::npos ? std::string_view() : rest.substr(dot + 1);
    if (name == "*") {
      for (const auto& [key, child] : value.items()) visit(child, after, rule, {&place, key});
      return;
    }
    const bool is_array = name.ends_with("[]");
    if (is_array) name.remove_suffix(2);
    const auto child = value.find(std::string(name));
    if (child == value.end()) return;
    const Place child_place{place.name.empty() && place.parent == nullptr ? nullptr : &place, name};
    if (!is_array) return visit(*child, after, rule, child_place);
    if (!child->is_array()) fail(child_place, *child, "an array");
    for (std::size_t i = 0; i < child->size(); ++i) visit((*child)[i], after, rule, {&child_place, {}, i, true});
  }

 private:
  [[noreturn]] void fail(const Place& place, const json& found, std::string_view expected) const {
    const std::string text = found.is_primitive() ? " (" + cleanName(found.dump()) + ")" : "";
    throw InputError(fmt::format("{}: {}: found {}{}, expected {}", cleanPath(path_), place.text(), found.type_name(),
                                 text, expected));
  }

  void checkInteger(json& value, double upper, const Place& place) const {
    if (!value.is_number()) fail(place, value, "an integer");
    const double number = value.get<double>();
    if (!(number >= 0 && number <= upper)) fail(place, value, fmt::format("an integer in [0, {:.0f}]", upper));
    if (value.is_number_integer()) return;
    if (std::floor(number) != number) fail(place, value, "an integer");
    // "2.0" is an integer to JSON Schema, and exporters in dynamic languages write it; tinygltf would not see it.
    value = static_cast<std::int64_t>(number);
  }

  void checkNumber(const json& value, const Place& place) const {
    if (!value.is_number()) fail(place, value, "a number");
    if (!(std::abs(value.get<double>()) <= static_cast<double>(std::numeric_limits<float>::max())))
      fail(place, value, "a number within single precision");
  }

  template <class Check>
  void checkArray(json& value, std::size_t length, const Place& place, const Check& check_element) const {
    if (!value.is_array()) fail(place, value, "an array");
    if (length != 0 && value.size() != length)
      throw InputError(
          fmt::format("{}: {}: found {} values, expected {}", cleanPath(path_), place.text(), value.size(), length));
    for (std::size_t i = 0; i < value.size(); ++i) check_element(value[i], Place{&place, {}, i, true});
  }

  void check(json& value, const Rule& rule, const Place& place) const {
    constexpr double kMaxInt = 2147483647.0;
    constexpr double kMaxSize = 9007199254740992.0;  // 2⁵³: whole numbers beyond it are not exact in JSON
    switch (rule.type) {
      case Type::kIndex:
        return checkInteger(value, kMaxInt, place);
      case Type::kSize:
        return checkInteger(value, kMaxSize, place);
      case Type::kNumber:
        return checkNumber(value, place);
      case Type::kNumbers:
        return checkArray(value, rule.length, place, [&](const json& v, const Place& p) { checkNumber(v, p); });
      case Type::kIndices:
        return checkArray(value, 0, place, [&](json& v, const Place& p) { checkInteger(v, kMaxInt, p); });
      case Type::kStrings:
        return checkArray(value, 0, place, [&](const json& v, const Place& p) {
          if (!v.is_string()) fail(p, v, "a string");
        });
      case Type::kString:
        if (!value.is_string()) fail(place, value, "a string");
        return;
      case Type::kBool:
        if (!value.is_boolean()) fail(place, value, "true or false");
        return;
      case Type::kObject:
        if (!value.is_object()) fail(place, value, "an object");
        return;
      case Type::kTexture:
        for (const Rule& texture_rule : kTextureRules) visit(value, texture_rule.path, texture_rule, place);
        return;
    }
  }

  const std::filesystem::path& path_;
};

}  // namespace

void checkTypes(json& root, const std::filesystem::path& path) {
  const TypeChecker checker(path);
  for (const Rule& rule : kRules) checker.visit(root, rule.path, rule, Place{});
}

}  // namespace nephroid::gltf
