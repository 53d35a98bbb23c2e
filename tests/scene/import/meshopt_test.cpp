// EXT_meshopt_compression: what meshoptimizer's own encoders pack is imported as it was.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>

#include "nephroid/error.h"
#include "support/gltf_builder.h"

namespace nephroid::gltf {
namespace {

using testing::HasSubstr;
using testing_support::json;

using Bytes = std::vector<unsigned char>;

Bytes packVertices(const void* vertices, std::size_t count, std::size_t stride) {
  Bytes packed(meshopt_encodeVertexBufferBound(count, stride));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), vertices, count, stride));
  return packed;
}

Bytes packTriangles(const std::vector<unsigned>& indices, std::size_t vertex_count) {
  Bytes packed(meshopt_encodeIndexBufferBound(indices.size(), vertex_count));
  packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), indices.data(), indices.size()));
  return packed;
}

Bytes packSequence(const std::vector<unsigned>& indices, std::size_t vertex_count) {
  Bytes packed(meshopt_encodeIndexSequenceBound(indices.size(), vertex_count));
  packed.resize(meshopt_encodeIndexSequence(packed.data(), packed.size(), indices.data(), indices.size()));
  return packed;
}

/// A filter's encoder, then the vertex encoder. `stride` is that of the filtered data.
Bytes packOct(const std::vector<vec4>& vectors, int bits, std::size_t stride) {
  Bytes filtered(vectors.size() * stride);
  meshopt_encodeFilterOct(filtered.data(), vectors.size(), stride, bits, &vectors[0].x);
  return packVertices(filtered.data(), vectors.size(), stride);
}

Bytes packQuat(const std::vector<vec4>& rotations, int bits) {
  Bytes filtered(rotations.size() * 8);
  meshopt_encodeFilterQuat(filtered.data(), rotations.size(), 8, bits, &rotations[0].x);
  return packVertices(filtered.data(), rotations.size(), 8);
}

/// Versions of meshoptimizer after 0.18 also take how exponents are shared, which is for quality: any will do.
template <class... Mode>
Bytes packExp(void (*encode)(void*, std::size_t, std::size_t, int, const float*, Mode...),
              const std::vector<vec3>& vectors, int bits) {
  Bytes filtered(vectors.size() * 12);
  encode(filtered.data(), vectors.size(), 12, bits, &vectors[0].x, Mode{}...);
  return packVertices(filtered.data(), vectors.size(), 12);
}

struct Packing {
  std::size_t count, stride;
  std::string mode = "ATTRIBUTES", filter = "NONE";
};

struct MeshoptBuilder : testing_support::GltfBuilder {
  /// @return index of a view whose data exist only packed, as gltfpack writes them
  int addPacked(const Bytes& packed, const Packing& packing) {
    const int index = addView(packed);
    json& view = root["bufferViews"][static_cast<std::size_t>(index)];
    json extension = {{"buffer", 0},
                      {"byteOffset", view["byteOffset"]},
                      {"byteLength", packed.size()},
                      {"byteStride", packing.stride},
                      {"count", packing.count},
                      {"mode", packing.mode},
                      {"filter", packing.filter}};
    stored_size_ = view["byteOffset"].get<std::size_t>() + packed.size();
    const std::size_t size = packing.count * packing.stride;
    view = {{"buffer", 1}, {"byteOffset", fallback_size_}, {"byteLength", size}};
    if (packing.mode == "ATTRIBUTES") view["byteStride"] = packing.stride;
    view["extensions"]["EXT_meshopt_compression"] = std::move(extension);
    fallback_size_ += (size + 3) / 4 * 4;
    return index;
  }

  int addPackedAccessor(const Bytes& packed, const Packing& packing, int component_type, const std::string& type,
                        bool normalized = false) {
    return append("accessors", {{"bufferView", addPacked(packed, packing)},
                                {"componentType", component_type},
                                {"type", type},
                                {"count", packing.count},
                                {"normalized", normalized}});
  }

  json& packedView() { return root["bufferViews"].back()["extensions"]["EXT_meshopt_compression"]; }

  /// Only after the last view, as it lists the buffers.
  SceneData loadPacked() {
    root["extensionsUsed"] = root["extensionsRequired"] = {"EXT_meshopt_compression"};
    if (root["nodes"][0].contains("extensions")) root["extensionsUsed"].push_back("EXT_mesh_gpu_instancing");
    root["buffers"] = {
        {{"uri", "data.bin"}, {"byteLength", stored_size_}},
        {{"byteLength", fallback_size_}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    return load();
  }

 private:
  std::size_t stored_size_ = 0, fallback_size_ = 0;
};

/// The triangles' corners, each triangle turned so that its least corner is first: encoders may turn them.
std::vector<std::array<float, 9>> cornersOf(const Mesh& mesh) {
  std::vector<std::array<float, 9>> triangles;
  for (const uvec3& t : mesh.triangles) {
    std::array<std::array<float, 3>, 3> corners{};
    for (int c = 0; c < 3; ++c) corners[c] = {mesh.positions[t[c]].x, mesh.positions[t[c]].y, mesh.positions[t[c]].z};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    std::array<float, 9> flat{};
    for (int i = 0; i < 9; ++i) flat[i] = corners[i / 3][i % 3];
    triangles.push_back(flat);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/// Seven corners of a fan: no multiple of four, in which decoders of SIMD builds work.
const std::vector<vec3>& fanPositions() {
  static const std::vector<vec3> positions{{0, 0, 0},         {1, 0, 0},         {0.5F, 0.875F, -1}, {-0.5F, 0.75F, 2},
                                           {-1, 0.125F, 0.5}, {-0.5F, -0.9F, 0}, {0.5F, -0.8F, -3}};
  return positions;
}
const std::vector<unsigned>& fanIndices() {
  static const std::vector<unsigned> indices{0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0, 5, 6};
  return indices;
}
Mesh makeFan() {
  Mesh mesh;
  mesh.positions = fanPositions();
  for (std::size_t i = 0; i < fanIndices().size(); i += 3)
    mesh.triangles.emplace_back(fanIndices()[i], fanIndices()[i + 1], fanIndices()[i + 2]);
  return mesh;
}

/// The fan, all packed, shown by one node.
struct PackedFan : MeshoptBuilder {
  explicit PackedFan(std::size_t index_stride = 2) {
    const std::size_t count = fanPositions().size();
    const int positions =
        addPackedAccessor(packVertices(fanPositions().data(), count, 12), {count, 12}, testing_support::kFloat, "VEC3");
    const int indices =
        addPackedAccessor(packTriangles(fanIndices(), count), {fanIndices().size(), index_stride, "TRIANGLES"},
                          index_stride == 2 ? testing_support::kUShort : testing_support::kUInt, "SCALAR");
    append("meshes", {{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}}}});
    addNode({{"mesh", 0}});
  }
  json& primitive() { return root["meshes"][0]["primitives"][0]; }
  json& attributes() { return primitive()["attributes"]; }
};

/// Directions in all octants, on axes and near the fold of the octahedron, as many as the fan has corners.
std::vector<vec4> makeDirections(float w) {
  std::vector<vec4> directions{
      {0, 0, -1, w},        {-1, 0, 0, w},           {0.3F, -0.5F, 0.8F, w}, {-0.3F, 0.5F, -0.8F, w},
      {-0.6F, -0.7F, 0, w}, {0.7F, 0.7F, -0.05F, w}, {0, -1, 0, w}};
  for (vec4& d : directions) d = vec4(normalize(vec3(d)), d.w);
  return directions;
}

/// The directions of the fan's corners, found by position: importers may reorder.
template <class Vector>
void expectDirections(const Mesh& mesh, const std::vector<Vector>& imported, const std::vector<vec4>& expected,
                      float tolerance) {
  ASSERT_EQ(imported.size(), fanPositions().size());
  for (std::size_t i = 0; i < fanPositions().size(); ++i) {
    const auto found = std::find(mesh.positions.begin(), mesh.positions.end(), fanPositions()[i]);
    ASSERT_NE(found, mesh.positions.end()) << i;
    const vec3 direction(imported[static_cast<std::size_t>(found - mesh.positions.begin())]);
    EXPECT_LT(length(direction - vec3(expected[i])), tolerance) << i;
  }
}

TEST(Meshopt, TrianglesOf16And32BitsAreThoseThatWerePacked) {
  for (const std::size_t index_stride : {2U, 4U}) {
    PackedFan fan(index_stride);
    const SceneData scene = fan.loadPacked();
    EXPECT_EQ(cornersOf(scene.meshes.at(0)), cornersOf(makeFan())) << index_stride;
    EXPECT_TRUE(scene.warnings.size() <= 1) << scene.warnings.at(0);  // that a floor, light or camera was added
  }
}

TEST(Meshopt, SequencesOfIndicesKeepTheirOrder) {
  for (const std::size_t index_stride : {2U, 4U}) {
    PackedFan fan;
    // Five indices: no whole number of triangles, which this mode allows.
    const std::vector<unsigned> strip{6, 0, 1, 2, 3};
    fan.primitive()["indices"] =
        fan.addPackedAccessor(packSequence(strip, fanPositions().size()), {strip.size(), index_stride, "INDICES"},
                              index_stride == 2 ? testing_support::kUShort : testing_support::kUInt, "SCALAR");
    fan.primitive()["mode"] = 5;
    Mesh expected = makeFan();
    expected.triangles = {{6, 0, 1}, {0, 2, 1}, {1, 2, 3}};
    EXPECT_EQ(cornersOf(fan.loadPacked().meshes.at(0)), cornersOf(expected)) << index_stride;
  }
}

// 8 bits: half a step of 1/127 in both octahedral coordinates and again in the three of the unit vector, in all less
// than 0.015. 16 bits: 256 times less, and the rounding of the decoder's single precision.
TEST(Meshopt, OctahedralNormalsPointWhereTheyDid) {
  for (const auto& [bits, stride, component, tolerance] :
       {std::tuple{8, 4U, testing_support::kByte, 0.015F}, std::tuple{16, 8U, testing_support::kShort, 1e-4F},
        std::tuple{12, 8U, testing_support::kShort, 1e-3F}}) {
    PackedFan fan;
    const std::vector<vec4> normals = makeDirections(0);
    fan.attributes()["NORMAL"] = fan.addPackedAccessor(
        packOct(normals, bits, stride), {normals.size(), stride, "ATTRIBUTES", "OCTAHEDRAL"}, component, "VEC3", true);
    const Mesh mesh = fan.loadPacked().meshes.at(0);
    expectDirections(mesh, mesh.normals, normals, tolerance);
  }
}

TEST(Meshopt, OctahedralTangentsKeepTheirHandedness) {
  for (const float handedness : {-1.0F, 1.0F}) {
    PackedFan fan;
    fan.attributes()["NORMAL"] = fan.addVec3(std::vector<vec3>(fanPositions().size(), vec3(0, 0, 1)));
    const std::vector<vec4> tangents = makeDirections(handedness);
    fan.attributes()["TANGENT"] =
        fan.addPackedAccessor(packOct(tangents, 8, 4), {tangents.size(), 4, "ATTRIBUTES", "OCTAHEDRAL"},
                              testing_support::kByte, "VEC4", true);
    const Mesh mesh = fan.loadPacked().meshes.at(0);
    expectDirections(mesh, mesh.tangents, tangents, 0.015F);
    for (const vec4& tangent : mesh.tangents) EXPECT_EQ(tangent.w, handedness);
  }
}

// 24 bits of mantissa, of which one is the sign: half a unit in 2^23 of the next power of two above. The exponent may
// be that of the vector's largest component, and version 0.18 writes none below that of 1.
TEST(Meshopt, ExponentialPositionsOfAnyMagnitudeAreExactToTheMantissa) {
  const std::vector<vec3> positions{{0, 0, 0},          {-1.5F, 0.1F, 1e-6F}, {1e6F, -1e5F, 3}, {-0.3F, 1.0F / 3, -7},
                                    {255.99F, -256, 1}, {1e-3F, -1e-3F, 0},   {2, 4, -8}};
  PackedFan fan;
  fan.attributes()["POSITION"] =
      fan.addPackedAccessor(packExp(meshopt_encodeFilterExp, positions, 24),
                            {positions.size(), 12, "ATTRIBUTES", "EXPONENTIAL"}, testing_support::kFloat, "VEC3");
  const Mesh mesh = fan.loadPacked().meshes.at(0);
  ASSERT_EQ(mesh.positions.size(), positions.size());
  for (const vec3& expected : positions) {
    const auto distance = [&](const vec3& p) { return length(p - expected); };
    const vec3 nearest = *std::ranges::min_element(mesh.positions, {}, distance);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(nearest[c], expected[c], 1.2e-7F * std::max(1.0F, maxComponent(glm::abs(expected))))
          << expected.x << ' ' << c;
  }
}

// Each component in turn is the largest, which is the one that is not stored; and q and −q are one rotation.
TEST(Meshopt, QuaternionsTurnInstancesAsTheyDid) {
  std::vector<vec4> rotations{{0.1F, 0.2F, -0.3F, 0.9F}, {0.9F, -0.1F, 0.3F, 0.2F}, {-0.2F, -0.9F, 0.1F, -0.3F},
                              {0.3F, 0.1F, 0.9F, -0.2F}, {0.1F, 0.3F, 0.2F, -0.9F}, {0, 0, 0, 1},
                              {0.5F, -0.5F, 0.5F, -0.5F}};
  for (vec4& q : rotations) q = normalize(q);
  PackedFan fan;
  const std::size_t count = rotations.size();
  std::vector<vec3> places;
  for (std::size_t i = 0; i < count; ++i) places.emplace_back(i, -2.0F * static_cast<float>(i), 0.25F);
  const int rotation = fan.addPackedAccessor(packQuat(rotations, 16), {count, 8, "ATTRIBUTES", "QUATERNION"},
                                             testing_support::kShort, "VEC4", true);
  const int translation =
      fan.addPackedAccessor(packExp(meshopt_encodeFilterExp, places, 16), {count, 12, "ATTRIBUTES", "EXPONENTIAL"},
                            testing_support::kFloat, "VEC3");
  fan.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"ROTATION", rotation},
                                                                                 {"TRANSLATION", translation}};
  const SceneData scene = fan.loadPacked();
  ASSERT_EQ(scene.instances.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    const mat4& world = scene.instances[i].world_from_object;
    const mat3 expected = glm::mat3_cast(quat(rotations[i].w, rotations[i].x, rotations[i].y, rotations[i].z));
    // Four components, each to half a step of 1/32767 and once more rounded when decoded.
    for (int c = 0; c < 3; ++c) EXPECT_LT(length(vec3(world[c]) - expected[c]), 3e-4F) << i;
    EXPECT_EQ(vec3(world[3]), places[i]);
  }
}

void expectRefusal(MeshoptBuilder& builder, const char* reason) {
  try {
    builder.loadPacked();
    FAIL() << reason;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("EXT_meshopt_compression"));
    EXPECT_THAT(error.what(), HasSubstr(reason));
  }
}

TEST(Meshopt, DamagedDataAreRefused) {
  PackedFan cut;
  cut.packedView()["byteLength"] = cut.packedView()["byteLength"].get<int>() - 1;
  expectRefusal(cut, "damaged");
  PackedFan other_mode;
  other_mode.packedView()["mode"] = "INDICES";
  expectRefusal(other_mode, "damaged");
}

TEST(Meshopt, FiltersAndModesThatDoNotFitTheStrideAreRefused) {
  const auto changeView = [](std::size_t view, const char* key, const json& value, const char* reason) {
    PackedFan fan;
    fan.root["bufferViews"][view]["extensions"]["EXT_meshopt_compression"][key] = value;
    expectRefusal(fan, reason);
  };
  changeView(0, "filter", "OCTAHEDRAL", "does not suit");
  changeView(0, "filter", "QUATERNION", "does not suit");
  changeView(0, "filter", "ROUND", "unknown");
  changeView(1, "filter", "EXPONENTIAL", "does not suit");
  changeView(0, "mode", "POINTS", "expected ATTRIBUTES, TRIANGLES or INDICES");
  changeView(0, "byteStride", 14, "does not suit");
  changeView(1, "byteStride", 8, "does not suit");
  changeView(1, "count", 14, "no whole number");
  changeView(0, "count", 1 << 30, "cannot come from");
}

}  // namespace
}  // namespace nephroid::gltf
