#include "scene/import/gltf_geometry.h"

#include <fmt/format.h>

#include <cstring>
#include <numeric>

#include "scene/import/gltf_draco.h"
#include "scene/import/mesh_repair.h"

namespace nephroid::gltf {
namespace {

/// The attributes of one primitive, compressed or not, behind one interface.
class AttributeSource {
 public:
  AttributeSource(Document& document, AccessorReader& reader, const tinygltf::Primitive& primitive, std::string place)
      : document_(document),
        reader_(reader),
        primitive_(primitive),
        place_(std::move(place)),
        draco_(readDraco(document, primitive, place_)) {}

  bool has(const std::string& name) const {
    return primitive_.attributes.contains(name) || (draco_ && draco_->attributes.contains(name));
  }

  int componentCount(const std::string& name) const {
    if (const auto* packed = findPacked(name)) return packed->components;
    return reader_.componentCount(primitive_.attributes.at(name), placeOfAttribute(name));
  }

  /// `vertices × sizeof(Vector) / 4` floats as vectors; empty if the primitive has no such attribute.
  template <class Vector>
  std::vector<Vector> read(const std::string& name, bool normalize = false) const {
    constexpr int kLength = static_cast<int>(sizeof(Vector) / sizeof(float));
    if (!has(name)) return {};
    std::vector<float> floats;
    if (const auto* packed = findPacked(name)) {
      if (packed->components != kLength)
        document_.fail(placeOfAttribute(name),
                       fmt::format("has {} components, expected {}", packed->components, kLength));
      floats = packed->values;
    } else {
      floats = reader_.readFloats(primitive_.attributes.at(name), kLength, placeOfAttribute(name), normalize);
    }
    std::vector<Vector> vectors(floats.size() / kLength);
    if (!vectors.empty()) std::memcpy(&vectors[0][0], floats.data(), vectors.size() * sizeof(Vector));
    return vectors;
  }

  std::vector<std::uint32_t> readIndices(std::size_t vertex_count) const {
    if (draco_) return draco_->indices;
    const auto indices = primitive_.attributes.find(kIndicesAttribute);
    if (indices != primitive_.attributes.end()) return reader_.readIndices(indices->second, place_ + ".indices");
    std::vector<std::uint32_t> in_order(vertex_count);
    std::iota(in_order.begin(), in_order.end(), 0U);
    return in_order;
  }

  std::string placeOfAttribute(const std::string& name) const { return place_ + "." + cleanName(name); }

 private:
  const DracoPrimitive::Attribute* findPacked(const std::string& name) const {
    if (!draco_) return nullptr;
    const auto found = draco_->attributes.find(name);
    return found == draco_->attributes.end() ? nullptr : &found->second;
  }

  Document& document_;
  AccessorReader& reader_;
  const tinygltf::Primitive& primitive_;
  std::string place_;
  std::optional<DracoPrimitive> draco_;
};

/// COLOR_0, with alpha 1 where the file has RGB only. Integers are normalised whether or not the accessor says so: glTF
/// allows nothing else.
std::vector<vec4> readColors(const AttributeSource& source) {
  if (!source.has("COLOR_0")) return {};
  if (source.componentCount("COLOR_0") == 4) return source.read<vec4>("COLOR_0", true);
  const std::vector<vec3> rgb = source.read<vec3>("COLOR_0", true);
  std::vector<vec4> colors;
  colors.reserve(rgb.size());
  for (const vec3& color : rgb) colors.emplace_back(color, 1.0F);
  return colors;
}

template <class T>
void checkCount(const Document& document, const std::vector<T>& values, std::size_t vertex_count,
                const std::string& place) {
  if (!values.empty() && values.size() != vertex_count)
    document.fail(place, fmt::format("has {} elements, POSITION has {}", values.size(), vertex_count));
}

void readAttributes(const Document& document, const AttributeSource& source, Mesh& mesh) {
  mesh.positions = source.read<vec3>("POSITION");
  mesh.normals = source.read<vec3>("NORMAL");
  // Without normals glTF asks for flat shading and for tangents to be ignored.
  if (!mesh.normals.empty()) mesh.tangents = source.read<vec4>("TANGENT");
  mesh.texcoords[0] = source.read<vec2>("TEXCOORD_0");
  mesh.texcoords[1] = source.read<vec2>("TEXCOORD_1");
  mesh.colors = readColors(source);
  const std::size_t count = mesh.positions.size();
  checkCount(document, mesh.normals, count, source.placeOfAttribute("NORMAL"));
  checkCount(document, mesh.tangents, count, source.placeOfAttribute("TANGENT"));
  checkCount(document, mesh.texcoords[0], count, source.placeOfAttribute("TEXCOORD_0"));
  checkCount(document, mesh.texcoords[1], count, source.placeOfAttribute("TEXCOORD_1"));
  checkCount(document, mesh.colors, count, source.placeOfAttribute("COLOR_0"));
}

void warnIgnored(Document& document, const tinygltf::Primitive& primitive, const std::string& place) {
  if (!primitive.targets.empty()) document.warn(place, "morph targets are ignored; the rest pose is shown");
  for (const auto& [name, accessor] : primitive.attributes) {
    const bool more_uv = name.starts_with("TEXCOORD_") && name != "TEXCOORD_0" && name != "TEXCOORD_1";
    const bool more_colors = name.starts_with("COLOR_") && name != "COLOR_0";
    if (more_uv || more_colors) document.warn(place, fmt::format("{} is ignored", cleanName(name)));
  }
}

std::vector<uvec3> readTriangles(Document& document, const AttributeSource& source, int mode, std::size_t vertex_count,
                                 const std::string& place) {
  const std::vector<std::uint32_t> indices = source.readIndices(vertex_count);
  for (std::size_t i = 0; i < indices.size(); ++i)
    if (indices[i] >= vertex_count)
      document.fail(place + ".indices",
                    fmt::format("index {} at {} is not below {} vertices", indices[i], i, vertex_count));
  const bool incomplete = mode == TINYGLTF_MODE_TRIANGLES ? indices.size() % 3 != 0 : indices.size() < 3;
  if (incomplete)
    document.warn(place,
                  fmt::format("{} indices make no whole number of triangles; the rest is dropped", indices.size()));
  return assembleTriangles(mode, indices);
}

void repair(Document& document, Mesh& mesh, const std::string& place) {
  dropUnusedVertices(mesh);
  if (const auto bad = findNonFinitePosition(mesh))
    document.fail(place + ".POSITION", fmt::format("vertex {} is not finite", *bad));
  const RepairCounts counts = repairAttributes(mesh);
  if (counts.normals > 0)
    document.warn(place, fmt::format("{} normals are zero or not finite; taken from the triangles", counts.normals));
  if (counts.tangents > 0) document.warn(place, "some tangents are zero or not finite; all are derived instead");
  if (counts.texcoords > 0)
    document.warn(place, fmt::format("{} texture coordinates are not finite; set to 0", counts.texcoords));
  if (counts.colors > 0)
    document.warn(place, fmt::format("{} vertex colours are negative or not finite; set to 0 there", counts.colors));
}

/// One primitive; without triangles if there is nothing to draw.
Mesh readPrimitive(Document& document, AccessorReader& reader, const tinygltf::Primitive& primitive,
                   const std::string& place) {
  Mesh mesh;
  const int mode = primitive.mode;
  if (mode < TINYGLTF_MODE_POINTS || mode > TINYGLTF_MODE_TRIANGLE_FAN)
    document.fail(place, fmt::format("mode {} is not in [0, 6]", mode));
  if (mode < TINYGLTF_MODE_TRIANGLES) {
    document.warn(place, "points and lines are not drawn");
    return mesh;
  }
  const AttributeSource source(document, reader, primitive, place);
  if (!source.has("POSITION")) {
    document.warn(place, "has no POSITION and is not drawn");
    return mesh;
  }
  warnIgnored(document, primitive, place);
  readAttributes(document, source, mesh);
  mesh.triangles = readTriangles(document, source, mode, mesh.positions.size(), place);
  repair(document, mesh, place);
  return mesh;
}

}  // namespace

std::vector<uvec3> assembleTriangles(int mode, const std::vector<std::uint32_t>& indices) {
  std::vector<uvec3> triangles;
  const std::size_t n = indices.size();
  if (n < 3) return triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    triangles.reserve(n / 3);
    for (std::size_t i = 0; i + 2 < n; i += 3) triangles.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
    return triangles;
  }
  if (mode != TINYGLTF_MODE_TRIANGLE_STRIP && mode != TINYGLTF_MODE_TRIANGLE_FAN) return triangles;
  triangles.reserve(n - 2);
  for (std::size_t i = 0; i + 2 < n; ++i) {
    const std::size_t odd = i % 2;
    const uvec3 triangle = mode == TINYGLTF_MODE_TRIANGLE_STRIP
                               ? uvec3(indices[i], indices[i + 1 + odd], indices[i + 2 - odd])
                               : uvec3(indices[i + 1], indices[i + 2], indices[0]);
    // Strips are stitched together with triangles that repeat a vertex; they are no surface.
    if (triangle.x != triangle.y && triangle.y != triangle.z && triangle.z != triangle.x) triangles.push_back(triangle);
  }
  return triangles;
}

std::vector<Mesh> readMesh(Document& document, AccessorReader& reader, std::size_t mesh_index,
                           const std::function<std::uint32_t(int)>& material_of) {
  const tinygltf::Mesh& source = document.model.meshes[mesh_index];
  const std::string mesh_place = placeOf("meshes", mesh_index, source.name);
  std::vector<Mesh> meshes;
  for (std::size_t i = 0; i < source.primitives.size(); ++i) {
    const std::string place = mesh_place + "." + placeOf("primitives", i);
    Mesh mesh = readPrimitive(document, reader, source.primitives[i], place);
    if (mesh.triangles.empty()) continue;
    mesh.name = source.name.empty() ? placeOf("meshes", mesh_index) : cleanName(source.name);
    if (source.primitives.size() > 1) mesh.name += fmt::format(".{}", i);
    mesh.material = material_of(source.primitives[i].material);
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

}  // namespace nephroid::gltf
