// Builds small glTF files for tests of the importer: JSON as a value, buffers as bytes, written to a folder of its own.
#pragma once

#include <gtest/gtest.h>

#include <unistd.h>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"
#include "scene/import/import.h"

namespace nephroid::testing_support {

using nlohmann::json;

enum ComponentType { kByte = 5120, kUByte = 5121, kShort = 5122, kUShort = 5123, kUInt = 5125, kFloat = 5126 };

/// A glTF document under construction, with one buffer beside it in "data.bin".
class GltfBuilder {
 public:
  json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", json::array()}}}}};

  GltfBuilder() {
    static std::atomic<int> counter = 0;
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ("nephroid_gltf_" + std::to_string(::getpid()) + "_" + std::to_string(counter++));
    std::filesystem::create_directories(folder_);
  }
  GltfBuilder(const GltfBuilder&) = delete;
  GltfBuilder& operator=(const GltfBuilder&) = delete;
  ~GltfBuilder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  const std::filesystem::path& folder() const { return folder_; }

  /// @return index of a new bufferView over `values`
  template <class T>
  int addView(const std::vector<T>& values) {
    while (bytes_.size() % 4 != 0) bytes_.push_back('\0');
    json view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", values.size() * sizeof(T)}};
    const std::size_t offset = bytes_.size();
    bytes_.resize(offset + values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(&bytes_[offset], values.data(), values.size() * sizeof(T));
    return append("bufferViews", view);
  }

  /// @return index of a new accessor over a new view of `values`
  template <class T>
  int addAccessor(const std::vector<T>& values, int component_type, const std::string& type, std::size_t count) {
    return append(
        "accessors",
        {{"bufferView", addView(values)}, {"componentType", component_type}, {"type", type}, {"count", count}});
  }
  int addVec3(const std::vector<vec3>& v) { return addAccessor(v, kFloat, "VEC3", v.size()); }
  int addVec4(const std::vector<vec4>& v) { return addAccessor(v, kFloat, "VEC4", v.size()); }
  int addFloats(const std::vector<float>& v) { return addAccessor(v, kFloat, "SCALAR", v.size()); }

  /// A right triangle in the xy plane that looks along +z. @return index of its mesh
  int addTriangleMesh() {
    const int positions = addVec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    return append("meshes", {{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}});
  }
  /// @return index of the new node, which the scene lists
  int addNode(const json& node) {
    const int index = append("nodes", node);
    root["scenes"][0]["nodes"].push_back(index);
    return index;
  }
  /// A triangle, shown, with `material`.
  void addTriangleWith(const json& material) {
    const int mesh = addTriangleMesh();
    root["meshes"][static_cast<std::size_t>(mesh)]["primitives"][0]["material"] = append("materials", material);
    addNode({{"mesh", mesh}});
  }

  int append(const char* array, const json& value) {
    root[array].push_back(value);
    return static_cast<int>(root[array].size()) - 1;
  }

  /// Writes the file and its buffer. @return the path of the .gltf file
  std::filesystem::path write() {
    json document = root;
    if (!bytes_.empty() && !document.contains("buffers"))
      document["buffers"] = {{{"uri", "data.bin"}, {"byteLength", bytes_.size()}}};
    writeFile("data.bin", bytes_);
    return writeFile("scene.gltf", document.dump());
  }

  std::filesystem::path writeFile(const std::string& name, std::string_view contents) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << contents;
    return folder_ / name;
  }

  SceneData load(float time = 0.0F) { return importGltf(write(), time); }

 private:
  std::filesystem::path folder_;
  std::string bytes_;
};

}  // namespace nephroid::testing_support
