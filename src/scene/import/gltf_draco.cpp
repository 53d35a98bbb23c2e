#include "scene/import/gltf_draco.h"

#include <draco/compression/decode.h>
#include <draco/core/decoder_buffer.h>
#include <draco/mesh/mesh.h>
#include <fmt/format.h>

#include "scene/import/accessor_reader.h"
#include "scene/import/gltf_value.h"

namespace nephroid::gltf {
namespace {

constexpr const char* kExtension = "KHR_draco_mesh_compression";

/// Largest value of an integer type: what a normalised 1 is stored as. 0 for types that cannot be normalised.
float integerRange(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return 127.0F;
    case draco::DT_UINT8:
      return 255.0F;
    case draco::DT_INT16:
      return 32767.0F;
    case draco::DT_UINT16:
      return 65535.0F;
    default:
      return 0.0F;
  }
}

std::unique_ptr<draco::Mesh> decode(const Document& document, std::span<const std::byte> bytes,
                                    const std::string& place) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto geometry = draco::Decoder::GetEncodedGeometryType(&buffer);
  if (!geometry.ok() || geometry.value() != draco::TRIANGULAR_MESH)
    document.fail(place, "holds no Draco triangle mesh");
  draco::Decoder decoder;
  auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
  if (!mesh.ok())
    document.fail(place, fmt::format("Draco cannot decode it ({})", cleanName(mesh.status().error_msg_string())));
  return std::move(mesh).value();
}

DracoPrimitive::Attribute readAttribute(const Document& document, const draco::Mesh& mesh,
                                        const draco::PointAttribute& attribute, bool normalized,
                                        const std::string& place) {
  DracoPrimitive::Attribute out;
  out.components = attribute.num_components();
  const auto components = static_cast<std::size_t>(out.components);
  // Draco scales what it was told is normalised; where only the accessor says so, we do.
  const float range = integerRange(attribute.data_type());
  const float scale = normalized && !attribute.normalized() && range > 0 ? 1.0F / range : 1.0F;
  out.values.resize(mesh.num_points() * components);
  for (std::uint32_t point = 0; point < mesh.num_points(); ++point) {
    const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(point));
    float* target = &out.values[point * components];
    if (value.value() >= attribute.size() ||
        !attribute.ConvertValue<float>(value, static_cast<std::int8_t>(out.components), target))
      document.fail(place, fmt::format("attribute value {} cannot be read", value.value()));
    for (std::size_t c = 0; c < components; ++c) target[c] *= scale;
  }
  return out;
}

void readFaces(const Document& document, const draco::Mesh& mesh, const std::string& place, DracoPrimitive& out) {
  out.indices.reserve(std::size_t{mesh.num_faces()} * 3);
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
    for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(f))) {
      if (corner.value() >= mesh.num_points())
        document.fail(place, fmt::format("index {} is not below {} vertices", corner.value(), mesh.num_points()));
      out.indices.push_back(corner.value());
    }
  }
}

bool isNormalized(const Document& document, const tinygltf::Primitive& primitive, const std::string& name) {
  const auto found = primitive.attributes.find(name);
  const auto& accessors = document.model.accessors;
  return found != primitive.attributes.end() && found->second >= 0 &&
         static_cast<std::size_t>(found->second) < accessors.size() &&
         accessors[static_cast<std::size_t>(found->second)].normalized;
}

}  // namespace

std::optional<DracoPrimitive> readDraco(const Document& document, const tinygltf::Primitive& primitive,
                                        const std::string& primitive_place) {
  const tinygltf::Value& extension = getExtension(primitive.extensions, kExtension);
  if (!isPresent(extension)) return std::nullopt;
  const std::string place = primitive_place + "." + kExtension;
  const ViewBytes view = document.view(getInt(extension, "bufferView", -1), place);
  const std::unique_ptr<draco::Mesh> mesh = decode(document, view.bytes, place);
  if (mesh->num_points() > kMaxElements)
    document.fail(place, fmt::format("{} vertices, expected at most {}", mesh->num_points(), kMaxElements));
  DracoPrimitive out;
  out.vertex_count = mesh->num_points();
  readFaces(document, *mesh, place, out);
  const tinygltf::Value& attributes = getMember(extension, "attributes");
  for (const std::string& name : attributes.Keys()) {
    const int id = getInt(attributes, name, -1);
    const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
    if (attribute == nullptr) document.fail(place, fmt::format("attribute {} (id {}) is missing", cleanName(name), id));
    if (attribute->num_components() < 1 || attribute->num_components() > 4) continue;
    out.attributes[name] = readAttribute(document, *mesh, *attribute, isNormalized(document, primitive, name),
                                         place + "." + cleanName(name));
  }
  return out;
}

}  // namespace nephroid::gltf
