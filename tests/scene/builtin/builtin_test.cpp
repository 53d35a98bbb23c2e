// Claims about the built-in scenes: all build, under every light, closed where they are solid, and as their parameters
// say.
#include "scene/builtin/builtin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <string_view>

#include "nephroid/error.h"
#include "scene/classify.h"
#include "scene/mesh_topology.h"
#include "scene/report.h"

namespace nephroid {
namespace {

/// Every scene that needs no file.
std::vector<std::string> proceduralNames() {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtinScenes())
    if (scene.name != "object") names.push_back(scene.name);
  return names;
}

const Instance& findInstance(const SceneData& scene, std::string_view name) {
  const auto found = std::ranges::find(scene.instances, name, &Instance::name);
  if (found == scene.instances.end()) throw InternalError("no instance " + std::string(name));
  return *found;
}

const Material& findMaterial(const SceneData& scene, std::string_view name) {
  const auto found = std::ranges::find(scene.materials, name, &Material::name);
  if (found == scene.materials.end()) throw InternalError("no material " + std::string(name));
  return *found;
}

double volumeOf(const SceneData& scene, const std::string& name) {
  for (const InstanceReport& r : inspectScene(scene).instances)
    if (r.name == name) return r.signed_volume;
  return 0;
}

template <class E>
std::string messageOf(const std::string& query, ExitCode& code) {
  try {
    buildBuiltinScene(query, 0);
  } catch (const E& error) {
    code = error.exitCode();
    return error.what();
  }
  return "nothing was thrown";
}

class EveryBuiltin : public ::testing::TestWithParam<std::string> {};
std::string nameOfCase(const ::testing::TestParamInfo<std::string>& test_case) {
  std::string name = test_case.param;
  std::erase(name, '-');  // not allowed in the name of a test
  return name;
}
INSTANTIATE_TEST_SUITE_P(Builtin, EveryBuiltin, ::testing::ValuesIn(proceduralNames()), &nameOfCase);

TEST_P(EveryBuiltin, CastsAndCatchesCausticsByDefault) {
  const SceneData scene = buildBuiltinScene(GetParam(), 0);
  const SceneReport report = inspectScene(scene);
  EXPECT_TRUE(std::ranges::any_of(report.instances, [](const auto& r) { return r.classification.is_generator; }));
  EXPECT_TRUE(std::ranges::any_of(report.instances, [](const auto& r) { return r.classification.is_receiver; }));
  EXPECT_EQ(report.diagnosis, std::vector<std::string>{});
  EXPECT_EQ(scene.cameras.size(), 1U);
  EXPECT_EQ(scene.name, "builtin:" + GetParam());
  EXPECT_GT(scene.triangleCount(), 10U);
  EXPECT_LT(scene.triangleCount(), 600'000U);
}

TEST_P(EveryBuiltin, HasEveryKindOfLight) {
  for (const std::string kind : {"sun", "point", "spot", "area", "env"}) {
    const SceneData scene = buildBuiltinScene(GetParam() + "?segments=16&light=" + kind, 0);
    const bool emits =
        std::ranges::any_of(scene.instances, [&](const Instance& i) { return scene.materialOf(i).emits(); });
    EXPECT_EQ(emits, kind == "area") << kind;
    EXPECT_EQ(scene.environment.has_value(), kind == "env") << kind;
    ASSERT_EQ(scene.lights.size(), kind == "area" || kind == "env" ? 0U : 1U) << kind;
    if (kind == "sun") {
      EXPECT_EQ(scene.lights[0].kind, LightKind::kSun);
    }
    if (kind == "point") {
      EXPECT_EQ(scene.lights[0].kind, LightKind::kPoint);
    }
    if (kind == "spot") {
      EXPECT_EQ(scene.lights[0].kind, LightKind::kSpot);
    }
  }
}

TEST_P(EveryBuiltin, SolidsAreClosedAndFaceOutwardsAndNothingIsDegenerate) {
  for (const InstanceReport& r : inspectScene(buildBuiltinScene(GetParam() + "?segments=100", 0)).instances) {
    SCOPED_TRACE(r.name);
    EXPECT_FALSE(r.inward);
    EXPECT_EQ(r.nonmanifold_edge_count, 0U);
    EXPECT_EQ(r.inconsistent_edge_count, 0U);
    EXPECT_EQ(r.degenerate_count, 0U);
    EXPECT_EQ(r.flipped_normal_count, 0U);
    const bool is_sheet = r.name == "floor" || r.name == "water" || r.name == "bed" || r.name == "terrain" ||
                          r.name == "coffee" || r.name.find("wall") != std::string::npos ||
                          r.name.find("plate") != std::string::npos;
    EXPECT_EQ(r.open_edge_count == 0, !is_sheet);
    if (!is_sheet) {
      EXPECT_GT(r.signed_volume, 0.0);
    }
  }
}

TEST_P(EveryBuiltin, HasUnitNormalsNearTheFacetsOfTheMesh) {
  const SceneData scene = buildBuiltinScene(GetParam() + "?segments=128", 0);
  for (const Mesh& mesh : scene.meshes) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    float worst_length = 0, worst_cosine = 1;
    for (const vec3 n : mesh.normals) worst_length = std::max(worst_length, std::abs(length(n) - 1.0F));
    for (const uvec3& t : mesh.triangles) {
      const dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
      const dvec3 facet = glm::normalize(glm::cross(b - a, c - a));
      for (const std::uint32_t v : {t.x, t.y, t.z})
        worst_cosine = std::min(worst_cosine, static_cast<float>(glm::dot(facet, dvec3(mesh.normals[v]))));
    }
    EXPECT_LT(worst_length, 1e-5F) << mesh.name;
    // The pole of a fish, a few facets around a rounded rim: the coarsest steps of about 30 degrees.
    EXPECT_GT(worst_cosine, 0.75F) << mesh.name;
  }
}

TEST_P(EveryBuiltin, ReceiversReflectDiffuselyOnly) {
  const SceneData scene = buildBuiltinScene(GetParam(), 0);
  for (const Material& material : scene.materials) {
    const Classification c = classify(material);
    if (c.is_receiver) {
      EXPECT_EQ(c.specular_albedo, 0.0F) << material.name;
    }
  }
}

TEST_P(EveryBuiltin, ScalesToTheSegmentsAskedFor) {
  const SceneData coarse = buildBuiltinScene(GetParam() + "?segments=16", 0);
  const SceneData fine = buildBuiltinScene(GetParam() + "?segments=64", 0);
  EXPECT_GT(fine.triangleCount(), coarse.triangleCount());
}

TEST(Builtin, DeclaresEachParameterOnceWithASentence) {
  for (const BuiltinScene& scene : builtinScenes()) {
    std::vector<std::string> names;
    for (const ParamSpec& spec : scene.params) {
      EXPECT_EQ(std::ranges::find(names, spec.name), names.end()) << scene.name << " " << spec.name;
      names.push_back(spec.name);
      EXPECT_FALSE(spec.text.empty()) << scene.name << " " << spec.name;
    }
    // Every default must pass its own check.
    ParamSet params(scene.params);
    for (const ParamSpec& spec : scene.params) EXPECT_NO_THROW(params.set(spec.name, params.toText(spec.name)));
  }
}

TEST(Builtin, ListsTheScenesOfTheDesign) {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtinScenes()) names.push_back(scene.name);
  const std::vector<std::string> expected{"ring",   "sphere", "sphere-box", "sphere-in-box", "cognac",
                                          "wave",   "cube",   "prism",      "building",      "pool",
                                          "seabed", "coffee", "slab",       "object"};
  EXPECT_EQ(names, expected);
}

TEST(Builtin, RefusesUnknownNamesAndListsThoseThereAre) {
  ExitCode code{};
  const std::string message = messageOf<UsageError>("spere", code);
  EXPECT_EQ(code, ExitCode::kUsage);
  EXPECT_NE(message.find("did you mean 'sphere'"), std::string::npos) << message;
  EXPECT_NE(message.find("seabed"), std::string::npos) << message;
}

TEST(Builtin, RefusesUnknownParametersAndValuesOutOfRange) {
  for (const std::string query : {"sphere?radios=1", "sphere?radius=-1", "sphere?light=moon", "ring?wall=1", "object",
                                  "slab?abbe=30&dispersion=1", "wave?amplitude=5", "sphere?radius"}) {
    ExitCode code{};
    const std::string message = messageOf<UsageError>(query, code);
    EXPECT_EQ(code, ExitCode::kUsage) << query << ": " << message;
    EXPECT_TRUE(message.starts_with("builtin:")) << message;
  }
}

// Volume of a sphere tessellated with n = 256 facets around and 128 from pole to pole: 1 − O(2π²/3n²·…) below the exact
// one; the deficit of a UV sphere is (π²/n²)(2/3 + 4/3·…) < 0.1 %.
TEST(Builtin, SphereHasTheVolumeOfABall) {
  const double volume = volumeOf(buildBuiltinScene("sphere?radius=2&segments=256", 0), "sphere");
  const double exact = 4.0 / 3.0 * std::numbers::pi * 8.0;
  EXPECT_LT(volume, exact);
  EXPECT_NEAR(volume, exact, 1e-3 * exact);
}

TEST(Builtin, SphereVerticesLieOnTheSphere) {
  const SceneData scene = buildBuiltinScene("sphere?radius=0.05&height=0.01&segments=1024", 0);
  const Mesh& mesh = scene.meshes[findInstance(scene, "sphere").mesh];
  EXPECT_EQ(mesh.triangles.size(), 1024U * (512U - 1U) * 2U);
  double worst = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const dvec3 from_centre = dvec3(mesh.positions[i]) - dvec3(0, 0.05F + 0.01F, 0);
    worst = std::max(worst, std::abs(glm::length(from_centre) - 0.05));
    ASSERT_LT(glm::distance(glm::normalize(from_centre), dvec3(mesh.normals[i])), 1e-6);
  }
  EXPECT_LT(worst, 1e-8);  // one float step at 0.1 m
}

TEST(Builtin, CubeAndSlabHaveTheirVolume) {
  EXPECT_NEAR(volumeOf(buildBuiltinScene("cube?size=0.5&turn=33", 0), "cube"), 0.125, 1e-6);
  EXPECT_NEAR(volumeOf(buildBuiltinScene("slab?size=0.2&thickness=0.03&tilt=40&segments=8", 0), "slab"), 0.0012, 1e-9);
}

// A ring of outer radius R, wall w and height h, sunk by h/10: pi (R² − (R−w)²) 1.1 h, times sin(2π/n)/(2π/n) for n
// facets.
TEST(Builtin, RingHasTheVolumeOfATube) {
  const double n = 256, facets = std::sin(2 * std::numbers::pi / n) * n / (2 * std::numbers::pi);
  const double exact = std::numbers::pi * (0.05 * 0.05 - 0.048 * 0.048) * 1.1 * 0.025 * facets;
  EXPECT_NEAR(volumeOf(buildBuiltinScene("ring?segments=256", 0), "ring"), exact, 1e-4 * exact);
}

TEST(Builtin, PrismHasTheApexAndSidesAskedFor) {
  const double area = 0.5 * 0.04 * 0.04 * std::sin(50.0 * std::numbers::pi / 180);
  EXPECT_NEAR(volumeOf(buildBuiltinScene("prism?apex=50&side=0.04&length=0.1", 0), "prism"), area * 0.1, 1e-9);
}

TEST(Builtin, SlabTiltsAboutZ) {
  const SceneData scene = buildBuiltinScene("slab?tilt=30&height=0.25", 0);
  const mat4& m = findInstance(scene, "slab").world_from_object;
  const vec3 up = transformVector(m, vec3(0, 1, 0)), along = transformVector(m, vec3(1, 0, 0));
  EXPECT_NEAR(up.x, -0.5F, 1e-6F);
  EXPECT_NEAR(up.y, std::sqrt(0.75F), 1e-6F);
  EXPECT_NEAR(along.y, 0.5F, 1e-6F);
  EXPECT_NEAR(m[3].y, 0.25F, 1e-6F);
}

TEST(Builtin, WiresIndexDispersionAndColourOfGlass) {
  const SceneData scene = buildBuiltinScene("slab?ior=1.7&abbe=40&color=0.5,0.6,0.7&attenuation-distance=0.3", 0);
  const Material& glass = findMaterial(scene, "slab");
  EXPECT_EQ(glass.ior, 1.7F);
  EXPECT_EQ(glass.dispersion, 0.5F);
  EXPECT_EQ(glass.attenuation_color, vec3(0.5F, 0.6F, 0.7F));
  EXPECT_EQ(glass.attenuation_distance, 0.3F);
  const SceneData same = buildBuiltinScene("slab?dispersion=0.5&attenuation=0.5,0.6,0.7", 0);
  EXPECT_EQ(findMaterial(same, "slab").dispersion, 0.5F);
  EXPECT_EQ(findMaterial(same, "slab").attenuation_color, vec3(0.5F, 0.6F, 0.7F));
}

TEST(Builtin, ClearGlassAbsorbsNothing) {
  const SceneData scene = buildBuiltinScene("sphere", 0);
  EXPECT_TRUE(std::isinf(findMaterial(scene, "sphere").attenuation_distance));
}

TEST(Builtin, GlassAndMetalCanBeSwapped) {
  const SceneData metal = buildBuiltinScene("sphere?material=metal", 0);
  EXPECT_EQ(findMaterial(metal, "sphere").metallic, 1.0F);
  EXPECT_EQ(findMaterial(metal, "sphere").transmission, 0.0F);
  const SceneData glass = buildBuiltinScene("ring?material=glass", 0);
  EXPECT_TRUE(findMaterial(glass, "ring").isSolidDielectric());
  EXPECT_EQ(findMaterial(glass, "ring").attenuation_color, vec3(1));
}

TEST(Builtin, SunStandsWhereAzimuthAndElevationSay) {
  const SceneData zenith =
      buildBuiltinScene("slab?light=sun&sun-elevation=90&sun-azimuth=37&irradiance=4&sun-angle=0.5", 0);
  EXPECT_EQ(zenith.lights[0].direction, vec3(0, -1, 0));
  EXPECT_EQ(zenith.lights[0].intensity, vec3(4));
  EXPECT_EQ(zenith.lights[0].angle_deg, 0.5F);
  const SceneData right = buildBuiltinScene("slab?light=sun&sun-elevation=30&sun-azimuth=90", 0);
  EXPECT_NEAR(right.lights[0].direction.x, -std::sqrt(0.75F), 1e-6F);  // it comes from +X
  EXPECT_NEAR(right.lights[0].direction.y, -0.5F, 1e-6F);
  EXPECT_NEAR(right.lights[0].direction.z, 0.0F, 1e-6F);
}

// Radiance × area = intensity along the normal; the square faces the target.
TEST(Builtin, AreaLightHasTheIntensityAskedForAndFacesItsTarget) {
  const SceneData scene =
      buildBuiltinScene("slab?light=area&light-width=0.2&intensity=3&light-position=1,2,0&light-target=1,0,0", 0);
  const Instance& light = findInstance(scene, "light");
  EXPECT_NEAR(scene.materialOf(light).emission.x * 0.04F, 3.0F, 1e-5F);
  EXPECT_NEAR(scene.meshes[light.mesh].normals[0].y, -1.0F, 1e-6F);
  EXPECT_FALSE(scene.materialOf(light).double_sided);
  EXPECT_FALSE(classify(scene.materialOf(light)).is_receiver);
}

TEST(Builtin, WaveOfOneIsACosineAlongX) {
  const SceneData scene =
      buildBuiltinScene("wave?waves=1&amplitude=0.03&wavelength=0.4&depth=0.6&size=2&segments=64", 0);
  const Mesh& mesh = scene.meshes[findInstance(scene, "water").mesh];
  ASSERT_EQ(mesh.positions.size(), 65U * 65U);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const double k = 2 * std::numbers::pi / 0.4F, x = mesh.positions[i].x;
    ASSERT_NEAR(mesh.positions[i].y, 0.6 + 0.03 * std::cos(k * x), 1e-6);
    const dvec3 normal = glm::normalize(dvec3(0.03 * k * std::sin(k * x), 1, 0));
    ASSERT_NEAR(glm::distance(normal, dvec3(mesh.normals[i])), 0, 1e-5);
  }
}

TEST(Builtin, CognacReachesIntoTheGlassAndYieldsToIt) {
  const SceneData scene = buildBuiltinScene("cognac?segments=64", 0);
  const Material &glass = findMaterial(scene, "glass"), &liquid = findMaterial(scene, "cognac");
  EXPECT_GT(glass.priority, liquid.priority);
  EXPECT_LT(liquid.attenuation_color.z, liquid.attenuation_color.x);
  // Half way into the wall: every wetted vertex of the liquid, but those of its flat top, is inside the glass.
  const Instance &glass_at = findInstance(scene, "glass"), &liquid_at = findInstance(scene, "cognac");
  const Mesh &glass_mesh = scene.meshes[glass_at.mesh], &mesh = scene.meshes[liquid_at.mesh];
  const float top = mesh.bounds().upper.y;
  int below = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); i += 7) {
    if (mesh.positions[i].y > 0.999F * top) continue;
    ++below;
    EXPECT_NEAR(computeWindingNumber(glass_mesh, mesh.positions[i]), 1.0, 1e-3);
  }
  EXPECT_GT(below, 20);
  EXPECT_NEAR(computeWindingNumber(glass_mesh, dvec3(0, 0.9 * top, 0)), 0.0, 1e-3);
}

TEST(Builtin, PoolIsAFunctionOfTimeAndSeed) {
  const auto water = [](const std::string& query, float time) {
    const SceneData scene = buildBuiltinScene(query, time);
    return scene.meshes[findInstance(scene, "water").mesh].positions;
  };
  EXPECT_EQ(water("pool", 1.5F), water("pool", 1.5F));
  EXPECT_NE(water("pool", 1.5F), water("pool", 1.6F));
  EXPECT_NE(water("pool?seed=2", 1.5F), water("pool?seed=3", 1.5F));
  EXPECT_GT(buildBuiltinScene("pool", 0).duration, 0.0F);
  // 100 × 100 cells, as in the source.
  EXPECT_EQ(water("pool", 0).size(), 101U * 101U);
}

TEST(Builtin, WaterOfThePoolEndsInsideItsWalls) {
  const SceneData scene = buildBuiltinScene("pool", 0);
  const Bounds water = scene.meshes[findInstance(scene, "water").mesh].bounds();
  const Bounds basin = scene.meshes[findInstance(scene, "basin").mesh].bounds();
  EXPECT_GT(water.upper.x, 2.0F);
  EXPECT_LT(water.upper.x, basin.upper.x);
  EXPECT_LT(water.upper.y, basin.upper.y);
}

TEST(Builtin, ObjectScalesAMeshToTheDiameterAndStandsItOnTheFloor) {
  const std::string path = ::testing::TempDir() + "nephroid_builtin_object.obj";
  // A wedge of 1 × 2 × 1 m, far from the origin.
  std::ofstream(path) << "v 3 3 3\nv 4 3 3\nv 3 5 3\nv 3 3 4\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const SceneData scene = buildBuiltinScene("object?radius=0.5&height=0.25&mesh=" + path, 0);
  std::filesystem::remove(path);
  const Bounds bounds = inspectScene(scene).instances[1].bounds;
  EXPECT_NEAR(bounds.lower.y, 0.25F, 1e-5F);
  EXPECT_NEAR(bounds.upper.y, 1.25F, 1e-5F);
  EXPECT_NEAR(bounds.centre().x, 0.0F, 1e-5F);
  EXPECT_NEAR(bounds.extent().z, 0.5F, 1e-5F);
  EXPECT_TRUE(findMaterial(scene, "object").isSolidDielectric());
}

}  // namespace
}  // namespace nephroid
