// The one place where bytes of a glTF buffer become numbers. Everything is checked before a byte is read.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"
#include "scene/import/gltf_document.h"

namespace nephroid::gltf {

/// Accessors with more elements are refused: 134 million vertices are more than the memory of a workstation renders.
inline constexpr std::size_t kMaxElements = std::size_t{1} << 27;
/// An accessor without a bufferView is all zeros but for its sparse values, so the file's size does not bound it; this
/// does (sixteen million vertices, 200 MB).
inline constexpr std::size_t kMaxElementsWithoutData = std::size_t{1} << 24;
/// All accessors together, each as often as it is read: many primitives may share one accessor, and a small hostile
/// file would otherwise keep us busy for hours.
inline constexpr std::size_t kMaxElementsRead = std::size_t{1} << 29;

/// Reads accessors of one document. Handles byteStride, every component type that attributes may have (also those of
/// KHR_mesh_quantization), normalised integers, sparse substitution, absent bufferViews (zeros) and compressed ones.
///
/// Checked: indices of accessors, views and buffers; that each element lies inside its view and each view inside its
/// buffer, without overflow; type and component type; that the stride holds an element; that sparse indices are below
/// the count. `min` and `max` are hints and ignored. Misaligned data are read correctly and warned about.
/// Every function throws InputError naming file, place and accessor.
class AccessorReader {
 public:
  /// @param document  outlives the reader
  explicit AccessorReader(Document& document) : document_(document) {}

  /// Number of elements, checked against `kMaxElements` only.
  std::size_t count(int accessor, std::string_view place) const;
  /// Number of components of an element: 1 to 4 (matrices are refused).
  int componentCount(int accessor, std::string_view place) const;

  /// Floats, `count × components`, element by element.
  /// @param components  what the accessor must have per element
  /// @param normalize   treat integers as fractions of their range even if the accessor does not say so (colours)
  std::vector<float> readFloats(int accessor, int components, std::string_view place, bool normalize = false);
  std::vector<vec2> readVec2(int accessor, std::string_view place);
  std::vector<vec3> readVec3(int accessor, std::string_view place);
  std::vector<vec4> readVec4(int accessor, std::string_view place);

  /// Unsigned integers of a SCALAR accessor; their range is the caller's to check.
  std::vector<std::uint32_t> readIndices(int accessor, std::string_view place);

 private:
  const tinygltf::Accessor& get(int accessor, std::string_view place) const;
  void spend(std::size_t elements, std::string_view place);

  Document& document_;
  std::size_t elements_read_ = 0;
};

}  // namespace nephroid::gltf
