// Values of extensions and extras, as tinygltf keeps them. Types of extensions were checked by gltf_schema; a value of
// another type (in extras) counts as absent.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/math.h"
#include "scene/import/gltf_document.h"

namespace nephroid::gltf {

/// The member of an object, or a null value.
const tinygltf::Value& getMember(const tinygltf::Value& object, std::string_view key);
/// The extension's value, or a null value.
const tinygltf::Value& getExtension(const tinygltf::ExtensionMap& extensions, std::string_view name);
inline bool isPresent(const tinygltf::Value& value) { return value.Type() != tinygltf::NULL_TYPE; }

int getInt(const tinygltf::Value& object, const std::string& key, int fallback);
float getFloat(const tinygltf::Value& object, const std::string& key, float fallback);
std::string getString(const tinygltf::Value& object, const std::string& key, const std::string& fallback);
/// Absent unless it is an array of exactly that many finite numbers.
std::optional<vec3> getVec3(const tinygltf::Value& object, const std::string& key);
std::optional<vec2> getVec2(const tinygltf::Value& object, const std::string& key);

}  // namespace nephroid::gltf
