// Importers over files that nobody here wrote: public sample assets must load, broken ones must be refused in one line.
// Every test prints a row, so that a run of all is a table: file, triangles, materials, lights, cameras, warnings.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "nephroid/error.h"
#include "scene/import/import.h"

namespace nephroid {
namespace {

namespace fs = std::filesystem;

fs::path assetPath(const std::string& relative) { return fs::path(NEPHROID_ASSET_DIR) / relative; }

std::vector<fs::path> listFiles(const std::string& folder, const std::vector<std::string>& extensions) {
  std::vector<fs::path> files;
  if (!fs::exists(assetPath(folder))) return files;
  for (const auto& entry : fs::recursive_directory_iterator(assetPath(folder)))
    if (std::find(extensions.begin(), extensions.end(), entry.path().extension().string()) != extensions.end())
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// GoogleTest names are alphanumeric.
std::string nameTest(const testing::TestParamInfo<fs::path>& info) {
  std::string name = fmt::format("{:03}_{}", info.index, fs::relative(info.param, assetPath("")).string());
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

std::string shortName(const fs::path& path) { return fs::relative(path, assetPath("")).string(); }

void printRow(const fs::path& path, const SceneData& scene) {
  fmt::print("{:<60} {:>8} triangles {:>3} materials {:>2} lights {:>2} cameras\n", shortName(path),
             scene.triangleCount(), scene.materials.size(), scene.lights.size(), scene.cameras.size());
  for (const std::string& warning : scene.warnings) fmt::print("    warning: {}\n", warning);
}

/// What every renderer relies on.
void checkScene(const SceneData& scene) {
  ASSERT_FALSE(scene.materials.empty());
  for (const std::string& warning : scene.warnings) EXPECT_EQ(warning.find('\n'), std::string::npos) << warning;
  for (const Instance& instance : scene.instances) ASSERT_LT(instance.mesh, scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) {
    ASSERT_LT(mesh.material, scene.materials.size());
    const std::size_t count = mesh.positions.size();
    for (const vec3& p : mesh.positions) ASSERT_TRUE(isFinite(p));
    for (const uvec3& t : mesh.triangles) ASSERT_LT(std::max({t.x, t.y, t.z}), count);
    for (const vec3& n : mesh.normals) ASSERT_NEAR(length(n), 1.0F, 1e-4F);
    ASSERT_TRUE(mesh.normals.empty() || mesh.normals.size() == count);
    ASSERT_TRUE(mesh.tangents.empty() || mesh.tangents.size() == count);
    ASSERT_TRUE(mesh.texcoords[0].empty() || mesh.texcoords[0].size() == count);
    ASSERT_TRUE(mesh.texcoords[1].empty() || mesh.texcoords[1].size() == count);
    ASSERT_TRUE(mesh.colors.empty() || mesh.colors.size() == count);
  }
  for (const Material& material : scene.materials) {
    for (const TextureRef* texture :
         {&material.base_color_texture, &material.normal_texture, &material.emission_texture}) {
      if (texture->valid()) {
        ASSERT_LT(texture->image, scene.images.size());
      }
    }
  }
}

/// Loads the file, or returns the message with which it was refused.
std::string tryImport(const fs::path& path) {
  try {
    const SceneData scene = importGltf(path, 0.0F);
    printRow(path, scene);
    checkScene(scene);
    return "";
  } catch (const InputError& error) {
    fmt::print("{:<60} refused: {}\n", shortName(path), error.what());
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    EXPECT_NE(std::string(error.what()).find(path.filename().string()), std::string::npos) << "the file is not named";
    return error.what();
  }
}

// ---- sample assets

class SampleGltf : public testing::TestWithParam<fs::path> {};

TEST_P(SampleGltf, LoadsOrIsRefusedByName) {
  const std::string refusal = tryImport(GetParam());
  // The one sample that asks for what is not supported: textures in KTX2 only.
  if (GetParam().string().find("ktx2") != std::string::npos) {
    EXPECT_NE(refusal.find("KTX2"), std::string::npos);
  } else {
    EXPECT_EQ(refusal, "");
  }
}

INSTANTIATE_TEST_SUITE_P(Khronos, SampleGltf, testing::ValuesIn(listFiles("assets/gltf", {".glb", ".gltf"})), nameTest);
INSTANTIATE_TEST_SUITE_P(Peers, SampleGltf, testing::ValuesIn(listFiles("peers", {".glb"})), nameTest);

struct ExpectedCount {
  const char* file;
  std::size_t triangles;
};

/// Counts from the assets' own list (README.md there): of the meshes, not of what the nodes show.
class TriangleCount : public testing::TestWithParam<ExpectedCount> {};

TEST_P(TriangleCount, MatchesTheAssetList) {
  const SceneData scene = importGltf(assetPath(std::string("assets/gltf/") + GetParam().file), 0.0F);
  std::size_t count = 0;
  for (const Mesh& mesh : scene.meshes) count += mesh.triangles.size();
  EXPECT_EQ(count, GetParam().triangles);
}

INSTANTIATE_TEST_SUITE_P(Assets, TriangleCount,
                         testing::Values(ExpectedCount{"Duck.glb", 4212}, ExpectedCount{"Duck-draco/Duck.gltf", 4212},
                                         ExpectedCount{"Duck-quantized/Duck.gltf", 4212},
                                         ExpectedCount{"BoxTextured-meshopt.glb", 12},
                                         ExpectedCount{"SimpleSparseAccessor/SimpleSparseAccessor.gltf", 12},
                                         ExpectedCount{"CornellBox-nvpro/cornellBox.gltf", 16720},
                                         ExpectedCount{"PokalGlasses-draco-webp.glb", 71703},
                                         ExpectedCount{"DispersionTest.glb", 51827}));

/// The same duck in four encodings: the same box, up to the quantisation step.
TEST(DuckVariants, HaveTheSameBounds) {
  const Bounds plain = importGltf(assetPath("assets/gltf/Duck.glb"), 0.0F).bounds();
  for (const char* file : {"Duck-draco/Duck.gltf", "Duck-quantized/Duck.gltf", "Duck-embedded.gltf"}) {
    const Bounds other = importGltf(assetPath(std::string("assets/gltf/") + file), 0.0F).bounds();
    // 10 bits is the coarsest position quantisation in use.
    EXPECT_LT(length(other.lower - plain.lower), length(plain.extent()) / 1024) << file;
    EXPECT_LT(length(other.upper - plain.upper), length(plain.extent()) / 1024) << file;
  }
}

TEST(LightsAsset, HasItsFourLightsAndCamera) {
  const SceneData scene = importGltf(assetPath("assets/gltf/Lights.glb"), 0.0F);
  ASSERT_EQ(scene.lights.size(), 4U);
  std::vector<int> kinds(3, 0);
  for (const Light& light : scene.lights) ++kinds[static_cast<std::size_t>(light.kind)];
  EXPECT_EQ(kinds, (std::vector<int>{1, 2, 1}));
  EXPECT_EQ(scene.cameras.size(), 1U);
}

TEST(SimpleInstancingAsset, ShowsEveryInstance) {
  EXPECT_GT(importGltf(assetPath("assets/gltf/SimpleInstancing.glb"), 0.0F).instances.size(), 1U);
}

TEST(RiggedAsset, WarnsThatTheSkinIsIgnored) {
  const SceneData scene = importGltf(assetPath("assets/gltf/RiggedSimple.glb"), 0.0F);
  EXPECT_TRUE(std::any_of(scene.warnings.begin(), scene.warnings.end(),
                          [](const std::string& w) { return w.find("skin") != std::string::npos; }));
}

// ---- broken glTF

class BrokenGltf : public testing::TestWithParam<fs::path> {};

TEST_P(BrokenGltf, LoadsOrIsRefusedInOneLine) { tryImport(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Assimp, BrokenGltf, testing::ValuesIn(listFiles("assets/broken/gltf", {".glb", ".gltf"})),
                         nameTest);

class ValidatorGltf : public testing::TestWithParam<fs::path> {};

int countErrors(const fs::path& file) {
  std::ifstream stream(file.string() + ".report.json");
  return nlohmann::json::parse(stream)["issues"]["numErrors"].get<int>();
}

/// Files in which the validator finds no error, but which ask for what we refuse on purpose.
bool isRefusedOnPurpose(const std::string& name) {
  return name == "non_relative_uri.gltf" ||   // names a file by URL
         name == "min_version_valid.gltf" ||  // minVersion 2.1: says that a reader of 2.0 must not try
         name == "named_objects.gltf" ||      // shows a mesh whose buffer has no data
         name == "unused_objects.gltf";       // the same
}

TEST_P(ValidatorGltf, LoadsIfTheValidatorFindsNoError) {
  const std::string refusal = tryImport(GetParam());
  if (isRefusedOnPurpose(GetParam().filename().string())) {
    EXPECT_NE(refusal, "");
  } else if (countErrors(GetParam()) == 0) {
    EXPECT_EQ(refusal, "");
  }
}

INSTANTIATE_TEST_SUITE_P(Khronos, ValidatorGltf,
                         testing::ValuesIn(listFiles("assets/broken/gltf-validator", {".glb", ".gltf"})), nameTest);

TEST(BrokenGltfFile, WithIndicesOutOfRangeIsRefused) {
  EXPECT_NE(tryImport(assetPath("assets/broken/gltf/IndexOutOfRange/IndexOutOfRange.gltf")), "");
}

TEST(BrokenGltfFile, WithRecursiveNodesIsRefused) {
  EXPECT_NE(tryImport(assetPath("assets/broken/gltf/RecursiveNodes.gltf")), "");
}

TEST(BrokenGltfFile, WithoutItsBufferNamesTheBuffer) {
  EXPECT_NE(tryImport(assetPath("assets/broken/gltf/MissingBin/BoxTextured.gltf")).find(".bin"), std::string::npos);
}

TEST(BrokenGltfFile, WithWrongTypesIsRefused) {
  for (const fs::path& file : listFiles("assets/broken/gltf/wrongTypes", {".gltf"})) EXPECT_NE(tryImport(file), "");
}

// ---- meshes

std::string tryImportMesh(const fs::path& path) {
  try {
    const Mesh mesh = importMesh(path);
    fmt::print("{:<60} {:>8} triangles {:>7} vertices\n", shortName(path), mesh.triangles.size(),
               mesh.positions.size());
    EXPECT_FALSE(mesh.triangles.empty());
    EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
    for (const uvec3& t : mesh.triangles) EXPECT_LT(std::max({t.x, t.y, t.z}), mesh.positions.size());
    for (const vec3& n : mesh.normals) EXPECT_NEAR(length(n), 1.0F, 1e-4F);
    return "";
  } catch (const InputError& error) {
    fmt::print("{:<60} refused: {}\n", shortName(path), error.what());
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
}

class SampleMesh : public testing::TestWithParam<fs::path> {};
TEST_P(SampleMesh, Loads) { EXPECT_EQ(tryImportMesh(GetParam()), ""); }
INSTANTIATE_TEST_SUITE_P(Meshes, SampleMesh, testing::ValuesIn(listFiles("assets/meshes", {".ply", ".obj"})), nameTest);

class BrokenMesh : public testing::TestWithParam<fs::path> {};
TEST_P(BrokenMesh, LoadsOrIsRefusedInOneLine) { tryImportMesh(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Obj, BrokenMesh, testing::ValuesIn(listFiles("assets/broken/obj", {".obj"})), nameTest);
INSTANTIATE_TEST_SUITE_P(Ply, BrokenMesh, testing::ValuesIn(listFiles("assets/broken/ply", {".ply"})), nameTest);

TEST(MeshFile, ThatIsValidLoads) {
  for (const char* file : {"ply/cube_binary_header_with_RN_newline.ply", "ply/cube_uv.ply",
                           "obj/box_without_lineending.obj", "obj/concave_polygon.obj"})
    EXPECT_EQ(tryImportMesh(assetPath(std::string("assets/broken/") + file)), "");
}

TEST(MeshFile, WithoutTrianglesIsRefused) {
  EXPECT_NE(tryImportMesh(assetPath("assets/broken/obj/empty.obj")), "");
  EXPECT_NE(tryImportMesh(assetPath("assets/broken/obj/tinyobj-points-prim.obj")), "");
}

}  // namespace
}  // namespace nephroid
