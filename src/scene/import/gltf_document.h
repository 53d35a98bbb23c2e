// A glTF file taken apart and checked in form: container, JSON, value types, buffers. No meaning yet.
//
// tinygltf turns the JSON into structures. Around it stand our own checks, because it reads optional values of the
// wrong type as absent, narrows integers unchecked, recurses without limit, opens whatever file a URI names, decodes
// images with stb, and refuses valid Draco and meshopt files (accessors without a bufferView, buffers without a URI).
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/import/text.h"
#include "scene/import/tinygltf.h"

namespace nephroid::gltf {

/// Where an image's encoded bytes are: a URI, or a bufferView (-1: none).
struct ImageSource {
  std::string name;
  std::string uri;
  std::string mime_type;
  int buffer_view = -1;
};

/// The bytes of a bufferView, inside its buffer, and the distance between elements (0: tightly packed).
struct ViewBytes {
  std::span<const std::byte> bytes;
  std::size_t stride = 0;
};

/// The attribute under which a primitive's `indices` accessor travels through tinygltf, which refuses index accessors
/// without a bufferView (Draco leaves it out, and the specification lets it mean zeros).
inline constexpr const char* kIndicesAttribute = "_NEPHROID_INDICES";

/// A loaded file. Not thread-safe; lives as long as one import.
struct Document {
  std::filesystem::path path;
  tinygltf::Model model;  ///< without buffers, images and skins
  std::vector<ImageSource> images;
  std::vector<std::vector<std::byte>> buffers;       ///< empty where the file gives no data
  std::vector<std::vector<std::byte>> decompressed;  ///< per bufferView; filled where EXT_meshopt_compression is used
  WarningList warnings;

  /// @throws InputError "FILE: PLACE: PROBLEM"
  [[noreturn]] void fail(std::string_view place, std::string_view problem) const;
  /// As `WarningList::add`, without the file's name, which the scene has.
  void warn(std::string_view place, std::string_view problem);

  /// The bytes of bufferView `index`, decompressed where it is compressed.
  /// @throws InputError if it, or its buffer, or its range does not exist
  ViewBytes view(int index, std::string_view place) const;
  /// As stored in the file: compressed data stay compressed.
  ViewBytes storedView(int buffer, std::size_t offset, std::size_t length, std::string_view place) const;
};

/// "meshes[3] 'Bowl'": how messages name a place in the file.
std::string placeOf(std::string_view array, std::size_t index, std::string_view name = {});

/// Reads, checks and loads everything but pixels.
/// @throws InputError
Document loadDocument(const std::filesystem::path& path);

/// The encoded bytes of an image.
/// @throws InputError
std::vector<std::byte> readImageBytes(const Document& document, const ImageSource& image, std::string_view place);

}  // namespace nephroid::gltf
