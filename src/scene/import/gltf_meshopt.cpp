#include "scene/import/gltf_meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include "scene/import/gltf_value.h"

namespace nephroid::gltf {
namespace {

constexpr const char* kExtension = "EXT_meshopt_compression";

/// No mode packs better: an unchanged byte costs two bits per sixteen (attributes), a triangle one byte (indices). Kept
/// wide for later formats; it bounds what a small hostile file can make us allocate.
constexpr std::size_t kMaxRatio = 4096;

struct Compressed {
  std::span<const std::byte> bytes;
  std::size_t count = 0, stride = 0;
  std::string mode, filter;
};

Compressed readExtension(const Document& document, const tinygltf::Value& extension, const std::string& place) {
  Compressed data;
  data.count = static_cast<std::size_t>(getInt(extension, "count", 0));
  data.stride = static_cast<std::size_t>(getInt(extension, "byteStride", 0));
  data.mode = getString(extension, "mode", "");
  data.filter = getString(extension, "filter", "NONE");
  data.bytes =
      document
          .storedView(getInt(extension, "buffer", -1), static_cast<std::size_t>(getInt(extension, "byteOffset", 0)),
                      static_cast<std::size_t>(getInt(extension, "byteLength", 0)), place)
          .bytes;
  return data;
}

void checkSizes(const Document& document, const Compressed& data, const std::string& place) {
  const bool is_attributes = data.mode == "ATTRIBUTES";
  if (!is_attributes && data.mode != "TRIANGLES" && data.mode != "INDICES")
    document.fail(place,
                  fmt::format("unknown mode '{}', expected ATTRIBUTES, TRIANGLES or INDICES", cleanName(data.mode)));
  const bool stride_fits = is_attributes ? data.stride % 4 == 0 && data.stride >= 4 && data.stride <= 256
                                         : data.stride == 2 || data.stride == 4;
  if (!stride_fits) document.fail(place, fmt::format("byteStride {} does not suit mode {}", data.stride, data.mode));
  if (data.mode == "TRIANGLES" && data.count % 3 != 0)
    document.fail(place, fmt::format("{} indices are no whole number of triangles", data.count));
  if (data.count == 0 || data.count * data.stride / kMaxRatio > data.bytes.size())
    document.fail(place, fmt::format("{} elements of {} bytes cannot come from {} bytes", data.count, data.stride,
                                     data.bytes.size()));
}

void applyFilter(const Document& document, const Compressed& data, std::vector<std::byte>& out,
                 const std::string& place) {
  if (data.filter == "NONE") return;
  const bool is_attributes = data.mode == "ATTRIBUTES";
  if (is_attributes && data.filter == "OCTAHEDRAL" && (data.stride == 4 || data.stride == 8))
    meshopt_decodeFilterOct(out.data(), data.count, data.stride);
  else if (is_attributes && data.filter == "QUATERNION" && data.stride == 8)
    meshopt_decodeFilterQuat(out.data(), data.count, data.stride);
  else if (is_attributes && data.filter == "EXPONENTIAL")
    meshopt_decodeFilterExp(out.data(), data.count, data.stride);
  else
    document.fail(place, fmt::format("filter '{}' is unknown or does not suit mode {} with byteStride {}",
                                     cleanName(data.filter), data.mode, data.stride));
}

std::vector<std::byte> decompress(const Document& document, const tinygltf::Value& extension,
                                  const std::string& place) {
  const Compressed data = readExtension(document, extension, place);
  checkSizes(document, data, place);
  // The decoders of SIMD builds write whole groups of four; filters do so in place, but never past `count` elements.
  std::vector<std::byte> out(data.count * data.stride);
  const auto* source = reinterpret_cast<const unsigned char*>(data.bytes.data());
  int status = 0;
  if (data.mode == "ATTRIBUTES")
    status = meshopt_decodeVertexBuffer(out.data(), data.count, data.stride, source, data.bytes.size());
  else if (data.mode == "TRIANGLES")
    status = meshopt_decodeIndexBuffer(out.data(), data.count, data.stride, source, data.bytes.size());
  else
    status = meshopt_decodeIndexSequence(out.data(), data.count, data.stride, source, data.bytes.size());
  if (status != 0) document.fail(place, fmt::format("damaged data (meshoptimizer error {})", status));
  applyFilter(document, data, out, place);
  return out;
}

}  // namespace

void decompressViews(Document& document) {
  const auto& views = document.model.bufferViews;
  document.decompressed.resize(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto extension = views[i].extensions.find(kExtension);
    if (extension == views[i].extensions.end()) continue;
    document.decompressed[i] = decompress(document, extension->second, placeOf("bufferViews", i) + "." + kExtension);
  }
}

}  // namespace nephroid::gltf
