#include "scene/import/accessor_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace nephroid::gltf {
namespace {

template <class T>
T load(const std::byte* source) {
  T value;
  std::memcpy(&value, source, sizeof(T));  // glTF is little-endian, as is every machine that Embree and Vulkan run on
  return value;
}

std::size_t componentBytes(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

/// One component as float; integers as they are, or as fractions of their range (glTF 2.0, section 3.6.2.2: the most
/// negative value maps to −1 like its neighbour).
float loadFloat(const std::byte* source, int component_type, bool normalized) {
  const auto scaled = [normalized](float value, float range) {
    return normalized ? std::max(value / range, -1.0F) : value;
  };
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return scaled(load<std::int8_t>(source), 127.0F);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return scaled(load<std::uint8_t>(source), 255.0F);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return scaled(load<std::int16_t>(source), 32767.0F);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return scaled(load<std::uint16_t>(source), 65535.0F);
    default:
      return load<float>(source);
  }
}

std::uint32_t loadIndex(const std::byte* source, int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(source);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(source);
    default:
      return load<std::uint32_t>(source);
  }
}

/// A run of `count` elements inside a view, checked to lie in it.
struct Elements {
  const std::byte* first = nullptr;
  std::size_t stride = 0;
};

/// @param element_bytes  size of one element, > 0
Elements locate(Document& document, int view_index, std::size_t offset, std::size_t count, std::size_t element_bytes,
                std::size_t alignment, const std::string& place) {
  const ViewBytes view = document.view(view_index, place);
  const std::size_t stride = view.stride == 0 ? element_bytes : view.stride;
  if (stride < element_bytes)
    document.fail(place, fmt::format("byteStride {} is smaller than an element of {} bytes", stride, element_bytes));
  // count <= kMaxElements and stride <= 252, so the product cannot overflow.
  const std::size_t extent = count == 0 ? 0 : (count - 1) * stride + element_bytes;
  if (offset > view.bytes.size() || extent > view.bytes.size() - offset)
    document.fail(place,
                  fmt::format("{} elements of {} bytes, {} bytes apart, from byte {} need {} bytes; bufferView {} "
                              "has {}",
                              count, element_bytes, stride, offset, extent, view_index, view.bytes.size()));
  if (offset % alignment != 0 || stride % alignment != 0)
    document.warn(place, fmt::format("is not aligned to {} bytes, as glTF demands", alignment));
  return {view.bytes.data() + offset, stride};
}

std::size_t unsignedOffset(int offset) { return static_cast<std::size_t>(std::max(offset, 0)); }

/// Calls `substitute(element, source)` for each element that a sparse accessor replaces.
template <class Substitute>
void readSparse(Document& document, const tinygltf::Accessor& accessor, std::size_t element_bytes,
                const std::string& place, const Substitute& substitute) {
  const auto& sparse = accessor.sparse;
  const std::string sparse_place = place + ".sparse";
  const int type = sparse.indices.componentType;
  const bool is_index = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                        type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (!is_index) document.fail(sparse_place, fmt::format("indices have component type {}, expected unsigned", type));
  if (sparse.count < 1 || static_cast<std::size_t>(sparse.count) > accessor.count)
    document.fail(sparse_place, fmt::format("count {} is not in [1, {}]", sparse.count, accessor.count));
  const auto count = static_cast<std::size_t>(sparse.count);
  const std::size_t index_bytes = componentBytes(type);
  const Elements indices = locate(document, sparse.indices.bufferView, unsignedOffset(sparse.indices.byteOffset), count,
                                  index_bytes, index_bytes, sparse_place + ".indices");
  const Elements values = locate(document, sparse.values.bufferView, unsignedOffset(sparse.values.byteOffset), count,
                                 element_bytes, componentBytes(accessor.componentType), sparse_place + ".values");
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t element = loadIndex(indices.first + i * indices.stride, type);
    if (element >= accessor.count)
      document.fail(sparse_place,
                    fmt::format("index {} is not below the accessor's count {}", element, accessor.count));
    substitute(element, values.first + i * values.stride);
  }
}

/// All elements, `components` each, through `convert(source)`; zeros where there are no data.
template <class T, class Convert>
std::vector<T> readElements(Document& document, const tinygltf::Accessor& accessor, std::size_t components,
                            const std::string& place, const Convert& convert) {
  const std::size_t component_bytes = componentBytes(accessor.componentType);
  const std::size_t element_bytes = components * component_bytes;
  Elements elements;
  if (accessor.bufferView >= 0)
    elements = locate(document, accessor.bufferView, accessor.byteOffset, accessor.count, element_bytes,
                      component_bytes, place);
  else if (accessor.count > kMaxElementsWithoutData)
    document.fail(
        place, fmt::format("{} elements without data, expected at most {}", accessor.count, kMaxElementsWithoutData));
  std::vector<T> out(accessor.count * components, T{});
  const auto copy = [&](std::size_t element, const std::byte* source) {
    for (std::size_t c = 0; c < components; ++c) out[element * components + c] = convert(source + c * component_bytes);
  };
  if (elements.first != nullptr)
    for (std::size_t i = 0; i < accessor.count; ++i) copy(i, elements.first + i * elements.stride);
  if (accessor.sparse.isSparse) readSparse(document, accessor, element_bytes, place, copy);
  return out;
}

std::string placeIn(std::string_view place, int accessor) { return fmt::format("{}: accessors[{}]", place, accessor); }

template <class Vector>
std::vector<Vector> group(const std::vector<float>& floats) {
  constexpr std::size_t kLength = sizeof(Vector) / sizeof(float);
  std::vector<Vector> vectors(floats.size() / kLength);
  if (!vectors.empty()) std::memcpy(&vectors[0][0], floats.data(), vectors.size() * sizeof(Vector));
  return vectors;
}

}  // namespace

const tinygltf::Accessor& AccessorReader::get(int accessor, std::string_view place) const {
  const auto& accessors = document_.model.accessors;
  if (accessor < 0 || static_cast<std::size_t>(accessor) >= accessors.size())
    document_.fail(place, fmt::format("refers to accessor {}, the file has {}", accessor, accessors.size()));
  const tinygltf::Accessor& found = accessors[static_cast<std::size_t>(accessor)];
  if (found.count == 0 || found.count > kMaxElements)
    document_.fail(placeIn(place, accessor), fmt::format("count {} is not in [1, {}]", found.count, kMaxElements));
  return found;
}

std::size_t AccessorReader::count(int accessor, std::string_view place) const { return get(accessor, place).count; }

int AccessorReader::componentCount(int accessor, std::string_view place) const {
  switch (get(accessor, place).type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
      return 4;
    default:
      document_.fail(placeIn(place, accessor), "is a matrix, expected numbers or vectors");
  }
}

void AccessorReader::spend(std::size_t elements, std::string_view place) {
  elements_read_ += elements;
  if (elements_read_ > kMaxElementsRead)
    document_.fail(place, fmt::format("more than {} accessor elements in all; split the file", kMaxElementsRead));
}

std::vector<float> AccessorReader::readFloats(int accessor, int components, std::string_view place, bool normalize) {
  const tinygltf::Accessor& info = get(accessor, place);
  const std::string accessor_place = placeIn(place, accessor);
  const int found = componentCount(accessor, place);
  if (found != components)
    document_.fail(accessor_place, fmt::format("has {} components per element, expected {}", found, components));
  const int type = info.componentType;
  if (componentBytes(type) == 0 || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
    document_.fail(accessor_place, fmt::format("component type {} is not allowed here; expected float or an 8- or "
                                               "16-bit integer",
                                               type));
  spend(info.count, place);
  const bool normalized = info.normalized || normalize;
  return readElements<float>(document_, info, static_cast<std::size_t>(components), accessor_place,
                             [=](const std::byte* source) { return loadFloat(source, type, normalized); });
}

std::vector<vec2> AccessorReader::readVec2(int accessor, std::string_view place) {
  return group<vec2>(readFloats(accessor, 2, place));
}

std::vector<vec3> AccessorReader::readVec3(int accessor, std::string_view place) {
  return group<vec3>(readFloats(accessor, 3, place));
}

std::vector<vec4> AccessorReader::readVec4(int accessor, std::string_view place) {
  return group<vec4>(readFloats(accessor, 4, place));
}

std::vector<std::uint32_t> AccessorReader::readIndices(int accessor, std::string_view place) {
  const tinygltf::Accessor& info = get(accessor, place);
  const std::string accessor_place = placeIn(place, accessor);
  const int type = info.componentType;
  const bool is_index = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                        type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (!is_index || componentCount(accessor, place) != 1)
    document_.fail(accessor_place, "holds no indices; expected SCALAR of an unsigned type");
  spend(info.count, place);
  return readElements<std::uint32_t>(document_, info, 1, accessor_place,
                                     [=](const std::byte* source) { return loadIndex(source, type); });
}

}  // namespace nephroid::gltf
