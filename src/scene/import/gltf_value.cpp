#include "scene/import/gltf_value.h"

namespace nephroid::gltf {
namespace {

const tinygltf::Value kNull;

/// The numbers of an array of `length` numbers within single precision.
std::optional<vec4> getNumbers(const tinygltf::Value& object, const std::string& key, int length) {
  const tinygltf::Value& array = getMember(object, key);
  if (!array.IsArray() || array.ArrayLen() != static_cast<std::size_t>(length)) return std::nullopt;
  vec4 numbers(0.0F);
  for (int i = 0; i < length; ++i) {
    const tinygltf::Value& element = array.Get(i);
    const double number = element.GetNumberAsDouble();
    if (!element.IsNumber() || !(std::abs(number) <= double{std::numeric_limits<float>::max()})) return std::nullopt;
    numbers[i] = static_cast<float>(number);
  }
  return numbers;
}

}  // namespace

const tinygltf::Value& getMember(const tinygltf::Value& object, std::string_view key) {
  return object.IsObject() ? object.Get(std::string(key)) : kNull;
}

const tinygltf::Value& getExtension(const tinygltf::ExtensionMap& extensions, std::string_view name) {
  const auto found = extensions.find(std::string(name));
  return found == extensions.end() ? kNull : found->second;
}

int getInt(const tinygltf::Value& object, const std::string& key, int fallback) {
  const tinygltf::Value& value = getMember(object, key);
  return value.IsInt() ? value.GetNumberAsInt() : fallback;
}

float getFloat(const tinygltf::Value& object, const std::string& key, float fallback) {
  const tinygltf::Value& value = getMember(object, key);
  if (!value.IsNumber()) return fallback;
  const double number = value.GetNumberAsDouble();
  return std::abs(number) <= double{std::numeric_limits<float>::max()} ? static_cast<float>(number) : fallback;
}

std::string getString(const tinygltf::Value& object, const std::string& key, const std::string& fallback) {
  const tinygltf::Value& value = getMember(object, key);
  return value.IsString() ? value.Get<std::string>() : fallback;
}

std::optional<vec3> getVec3(const tinygltf::Value& object, const std::string& key) {
  const auto numbers = getNumbers(object, key, 3);
  return numbers ? std::optional(vec3(*numbers)) : std::nullopt;
}

std::optional<vec2> getVec2(const tinygltf::Value& object, const std::string& key) {
  const auto numbers = getNumbers(object, key, 2);
  return numbers ? std::optional(vec2(*numbers)) : std::nullopt;
}

}  // namespace nephroid::gltf
