// KHR_draco_mesh_compression: whole primitives that Draco has packed.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/import/gltf_document.h"

namespace nephroid::gltf {

/// What a compressed primitive holds. Every attribute has `vertex_count` elements.
struct DracoPrimitive {
  struct Attribute {
    int components = 0;
    std::vector<float> values;  ///< `vertex_count × components`
  };
  std::size_t vertex_count = 0;
  std::vector<std::uint32_t> indices;           ///< of a triangle list, all below `vertex_count`
  std::map<std::string, Attribute> attributes;  ///< by glTF name; only those with 1 to 4 components
};

/// Decodes the primitive if it is compressed.
/// @throws InputError
std::optional<DracoPrimitive> readDraco(const Document& document, const tinygltf::Primitive& primitive,
                                        const std::string& place);

}  // namespace nephroid::gltf
