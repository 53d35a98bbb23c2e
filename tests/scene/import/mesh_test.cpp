#include <gtest/gtest.h>

#include <cmath>

#include "nephroid/error.h"
#include "scene/import/mesh_repair.h"
#include "support/gltf_builder.h"

namespace nephroid {
namespace {

using testing_support::GltfBuilder;

/// Two squares that share the edge x = 0 and meet at `angle` between their normals, as four triangles with vertices of
/// their own.
Mesh makeFold(float angle) {
  Mesh mesh;
  const vec3 left(-std::cos(angle), std::sin(angle) * -1.0F, 0);
  const vec3 a(0, 0, 0), b(0, 0, -1), right(1, 0, 0);
  const vec3 corners[4][3] = {{a, right, right + b}, {a, right + b, b}, {a, b, left}, {left, b, left + b}};
  for (const auto& triangle : corners) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const vec3& p : triangle) mesh.positions.push_back(p);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return mesh;
}

/// Normal at the first corner that lies on the fold.
vec3 normalAtFold(const Mesh& mesh) { return mesh.normals[mesh.triangles[0].x]; }

TEST(SmoothNormals, AreSharedAcrossAShallowFold) {
  Mesh mesh = makeFold(radians(50));
  computeSmoothNormals(mesh, radians(60));
  // At a corner of the fold each side has triangles with 45° + 45° or 90°: equal weights, so the bisector.
  EXPECT_LT(length(normalAtFold(mesh) - vec3(-std::sin(radians(25)), std::cos(radians(25)), 0)), 1e-5F);
}

TEST(SmoothNormals, AreSplitAtACrease) {
  Mesh mesh = makeFold(radians(70));
  computeSmoothNormals(mesh, radians(60));
  EXPECT_LT(length(normalAtFold(mesh) - vec3(0, 1, 0)), 1e-6F);
}

TEST(SmoothNormals, OfASphereAreRadial) {
  GltfBuilder builder;
  // An octahedron with shared vertices as OBJ: each normal is along its vertex, by symmetry; its edges turn by 70.5°,
  // so that importMesh splits them and every normal is a face normal instead.
  const auto path = builder.writeFile("octahedron.obj",
                                      "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
                                      "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n");
  Mesh mesh = importMesh(path);
  ASSERT_EQ(mesh.triangles.size(), 8U);
  for (std::size_t i = 0; i < mesh.normals.size(); ++i)
    EXPECT_NEAR(dot(mesh.normals[i], mesh.positions[i]), std::sqrt(1.0F / 3), 1e-5F);
  computeSmoothNormals(mesh, radians(80));
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) EXPECT_LT(length(mesh.normals[i] - mesh.positions[i]), 1e-5F);
}

TEST(ImportMesh, MergesGltfNodesAndTurnsMirroredOnesOutward) {
  GltfBuilder builder;
  const int mesh = builder.addTriangleMesh();
  builder.addNode({{"mesh", mesh}});
  builder.addNode({{"mesh", mesh}, {"scale", {-1, 1, 1}}, {"translation", {-1, 0, 0}}});
  const Mesh merged = importMesh(builder.write());
  ASSERT_EQ(merged.triangles.size(), 2U);
  for (const uvec3& t : merged.triangles) {
    const vec3 normal =
        cross(merged.positions[t.y] - merged.positions[t.x], merged.positions[t.z] - merged.positions[t.x]);
    EXPECT_GT(normal.z, 0.0F);
  }
  for (const vec3& normal : merged.normals) EXPECT_EQ(normal, vec3(0, 0, 1));
}

TEST(ImportMesh, ReadsAsciiStl) {
  GltfBuilder builder;
  const auto path =
      builder.writeFile("t.stl",
                        "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                        "endloop\nendfacet\nendsolid t\n");
  EXPECT_EQ(importMesh(path).triangles.size(), 1U);
}

TEST(ImportMesh, RefusesOtherFormatsAndEmptyFiles) {
  GltfBuilder builder;
  EXPECT_THROW(importMesh(builder.writeFile("a.fbx", "Kaydara")), InputError);
  EXPECT_THROW(importMesh(builder.writeFile("a.obj", "")), InputError);
  EXPECT_THROW(importMesh(builder.writeFile("a.obj", "v 0 0 0\n")), InputError);
  EXPECT_THROW(importMesh(builder.writeFile("a.ply", "v 0 0 0\n")), InputError);
  EXPECT_THROW(importMesh(builder.folder() / "missing.ply"), InputError);
}

TEST(ImportMesh, NeverReadsAnObjFileAsItsOwnMaterials) {
  // "a" is no word of OBJ, but one of material libraries; the file names itself in every way there is.
  GltfBuilder builder;
  for (const char* library : {"none.mtl", "a.obj", "$$$___magic___$$$.obj", "mesh.obj", "mesh\\\n.obj"}) {
    const auto path =
        builder.writeFile("a.obj", "mtllib " + std::string(library) + "\na 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(importMesh(path).triangles.size(), 1U) << library;
  }
}

TEST(ImportMesh, RefusesNonFinitePositions) {
  GltfBuilder builder;
  EXPECT_THROW(importMesh(builder.writeFile("a.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")), InputError);
}

TEST(ImportMesh, RefusesPlyIndicesOutOfRange) {
  GltfBuilder builder;
  for (const char* index : {"3", "-1", "4000000"})
    EXPECT_THROW(importMesh(builder.writeFile("a.ply",
                                              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                              "property float y\nproperty float z\nelement face 1\n"
                                              "property list uchar int vertex_indices\nend_header\n"
                                              "0 0 0\n1 0 0\n0 1 0\n3 0 1 " +
                                                  std::string(index) + "\n")),
                 InputError)
        << index;
}

/// One triangle in ASCII PLY, with `vertices` before the element "vertex" and `list` among the properties of the face.
std::string makePly(const std::string& vertices, const std::string& list = "", const std::string& values = "") {
  return "ply\nformat ascii 1.0\n" + vertices +
         "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
         "property list uchar int vertex_indices\n" +
         list + "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2" + values + "\n";
}

TEST(ImportMesh, RefusesPlyElementsThatAreThereTwice) {
  GltfBuilder builder;
  EXPECT_EQ(importMesh(builder.writeFile("once.ply", makePly(""))).triangles.size(), 1U);
  EXPECT_THROW(importMesh(builder.writeFile("a.ply", makePly("element vertex 1\nproperty float x\n"))), InputError);
  EXPECT_THROW(importMesh(builder.writeFile(
                   "a.ply", makePly("", "element tristrips 1\nproperty list int int vertex_indices\n", "\n3 0 1 2"))),
               InputError);
}

TEST(ImportMesh, RefusesPlyHeadersOfTwoFormatsOrNone) {
  GltfBuilder builder;
  EXPECT_THROW(importMesh(builder.writeFile("a.ply", makePly("format binary_little_endian 1.0\n"))), InputError);
  std::string text = makePly("");
  text.erase(text.find("format"), 17);
  EXPECT_THROW(importMesh(builder.writeFile("a.ply", text)), InputError);
}

TEST(ImportMesh, PlyCommentsAreNoElements) {
  GltfBuilder builder;
  for (const char* comment : {"comment vertex 1\n", "comment element vertex 1\n", "obj_info material 4000000000\n"})
    EXPECT_EQ(importMesh(builder.writeFile("a.ply", makePly(comment))).triangles.size(), 1U) << comment;
}

TEST(ImportMesh, RefusesControlCharactersInPlyNames) {
  GltfBuilder builder;
  std::string text = makePly("");
  text.replace(text.find("float y"), 7, std::string("float x\0y", 9));
  EXPECT_THROW(importMesh(builder.writeFile("a.ply", text)), InputError);
}

/// Assimp would look up the fourth corner of a triangle.
TEST(ImportMesh, LeavesOutTextureCoordinatesOfPlyFaces) {
  GltfBuilder builder;
  const auto path =
      builder.writeFile("a.ply", makePly("", "property list uchar float texcoord\n", " 8 0 0 1 0 0 1 1 1"));
  const Mesh mesh = importMesh(path);
  EXPECT_EQ(mesh.triangles.size(), 1U);
  EXPECT_TRUE(mesh.texcoords[0].empty());
}

/// A PLY file cut anywhere is refused, never read past its end.
TEST(ImportMesh, RefusesEveryTruncationOfAPlyFile) {
  GltfBuilder builder;
  const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::string face("\x03\x00\x00\x00\x00\x01\x00\x00\x00\x02\x00\x00\x00", 13);
  const std::string whole =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" +
      std::string(reinterpret_cast<const char*>(positions), 36) + face;
  EXPECT_EQ(importMesh(builder.writeFile("whole.ply", whole)).triangles.size(), 1U);
  for (std::size_t size = 0; size < whole.size(); size += 3)
    EXPECT_THROW(importMesh(builder.writeFile("cut.ply", whole.substr(0, size))), InputError) << size;
}

}  // namespace
}  // namespace nephroid
