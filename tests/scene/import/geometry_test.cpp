#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nephroid/error.h"
#include "scene/import/gltf_geometry.h"
#include "support/gltf_builder.h"

namespace nephroid::gltf {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing_support::GltfBuilder;
using testing_support::json;

TEST(AssembleTriangles, KeepsTheSenseOfStripsAndFans) {
  EXPECT_EQ(assembleTriangles(TINYGLTF_MODE_TRIANGLES, {0, 1, 2, 3, 4}), (std::vector<uvec3>{{0, 1, 2}}));
  EXPECT_EQ(assembleTriangles(TINYGLTF_MODE_TRIANGLE_STRIP, {0, 1, 2, 3}), (std::vector<uvec3>{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_EQ(assembleTriangles(TINYGLTF_MODE_TRIANGLE_FAN, {0, 1, 2, 3}), (std::vector<uvec3>{{1, 2, 0}, {2, 3, 0}}));
}

TEST(AssembleTriangles, DropsTheStitchesOfStrips) {
  // Six triangles, of which only the first (even) and the last (odd) have three different corners.
  EXPECT_EQ(assembleTriangles(TINYGLTF_MODE_TRIANGLE_STRIP, {0, 1, 2, 2, 3, 3, 4, 5}),
            (std::vector<uvec3>{{0, 1, 2}, {3, 5, 4}}));
}

TEST(AssembleTriangles, YieldsNothingFromTooFewIndices) {
  for (int mode = 0; mode <= 6; ++mode) EXPECT_TRUE(assembleTriangles(mode, {0, 1}).empty());
}

/// A triangle whose primitive can be changed.
struct OneTriangle : GltfBuilder {
  OneTriangle() { addNode({{"mesh", addTriangleMesh()}}); }
  json& primitive() { return root["meshes"][0]["primitives"][0]; }
};

TEST(Primitive, WithIndicesOutOfRangeIsRefused) {
  OneTriangle builder;
  builder.primitive()["indices"] =
      builder.addAccessor(std::vector<std::uint8_t>{0, 1, 3}, testing_support::kUByte, "SCALAR", 3);
  EXPECT_THROW(builder.load(), InputError);
}

TEST(Primitive, WithoutNormalsIsLeftFlat) {
  OneTriangle builder;
  EXPECT_TRUE(builder.load().meshes.at(0).normals.empty());
}

TEST(Primitive, OfPointsOrLinesIsSkippedWithAWarning) {
  OneTriangle builder;
  builder.primitive()["mode"] = 1;
  const SceneData scene = builder.load();
  EXPECT_TRUE(scene.instances.empty());
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("lines")));
}

TEST(Primitive, WithNonFinitePositionsIsRefused) {
  OneTriangle builder;
  builder.primitive()["attributes"]["POSITION"] = builder.addVec3({{0, 0, 0}, {std::nanf(""), 0, 0}, {0, 1, 0}});
  EXPECT_THROW(builder.load(), InputError);
}

TEST(Primitive, WithFewerNormalsThanPositionsIsRefused) {
  OneTriangle builder;
  builder.primitive()["attributes"]["NORMAL"] = builder.addVec3({{0, 0, 1}});
  EXPECT_THROW(builder.load(), InputError);
}

TEST(Primitive, GetsUnitNormalsAndRepairsBadOnes) {
  OneTriangle builder;
  builder.primitive()["attributes"]["NORMAL"] = builder.addVec3({{0, 0, 5}, {0, 0, 0}, {std::nanf(""), 0, 0}});
  const SceneData scene = builder.load();
  for (const vec3& normal : scene.meshes.at(0).normals) EXPECT_EQ(normal, vec3(0, 0, 1));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("2 normals")));
}

TEST(Primitive, DropsVerticesThatNoTriangleUses) {
  OneTriangle builder;
  builder.primitive()["attributes"]["POSITION"] =
      builder.addVec3({{99, 99, 99}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {std::nanf(""), 0, 0}});
  builder.primitive()["indices"] =
      builder.addAccessor(std::vector<std::uint8_t>{1, 2, 3}, testing_support::kUByte, "SCALAR", 3);
  const SceneData scene = builder.load();
  EXPECT_EQ(scene.meshes.at(0).positions.size(), 3U);
  EXPECT_EQ(scene.meshes.at(0).bounds().upper, vec3(1, 1, 0));
}

TEST(Primitive, ReadsQuantisedColoursAsFractions) {
  OneTriangle builder;
  builder.primitive()["attributes"]["COLOR_0"] =
      builder.addAccessor(std::vector<std::uint8_t>{255, 0, 51, 255, 255, 255, 255, 255, 255, 255, 255, 0},
                          testing_support::kUByte, "VEC4", 3);
  const Mesh mesh = builder.load().meshes.at(0);
  EXPECT_EQ(mesh.colors.at(0), vec4(1, 0, 0.2F, 1));
}

TEST(Primitive, WithoutMaterialGetsGltfsDefault) {
  OneTriangle builder;
  const SceneData scene = builder.load();
  EXPECT_EQ(scene.materials.at(scene.meshes.at(0).material).metallic, 1.0F);
}

TEST(Primitive, WithoutTheUvSetOfItsTextureIsWarnedAbout) {
  OneTriangle builder;
  builder.primitive()["material"] = 0;
  // A 1×1 PNG.
  builder.root["images"] = {
      {{"uri",
        "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9"
        "awAAAABJRU5ErkJggg=="}}};
  builder.root["textures"] = {{{"source", 0}}};
  builder.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}}}};
  EXPECT_THAT(builder.load().warnings, Contains(HasSubstr("UV set 1")));
}

}  // namespace
}  // namespace nephroid::gltf
