#include "scene/report.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>

#include <nlohmann/json.hpp>

#include "scene/builtin/builtin.h"
#include "scene/mesh_topology.h"

namespace nephroid {
namespace {

/// A unit tetrahedron with its right angle at the origin: volume 1/6, wound outwards.
Mesh makeTetrahedron() {
  Mesh mesh;
  mesh.name = "tetrahedron";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

Material makeGlass() {
  Material m;
  m.name = "glass";
  m.roughness = 0;
  m.transmission = 1;
  m.thickness = 1;
  return m;
}

/// The tetrahedron of `material` over a diffuse floor under a sun.
SceneData makeScene(Material material, Mesh mesh = makeTetrahedron()) {
  SceneData scene;
  scene.name = "test";
  Material sand;
  sand.name = "sand";
  Mesh floor;
  floor.name = "floor";
  floor.positions = {{-9, -1, -9}, {-9, -1, 9}, {9, -1, 9}};
  floor.triangles = {{0, 1, 2}};
  floor.material = 1;
  scene.materials = {std::move(material), sand};
  scene.meshes = {std::move(mesh), floor};
  scene.instances.resize(2);
  scene.instances[0].name = "thing";
  scene.instances[1].name = "floor";
  scene.instances[1].mesh = 1;
  Light sun;
  sun.name = "sun";
  sun.kind = LightKind::kSun;
  scene.lights = {sun};
  return scene;
}

bool mentions(const std::vector<std::string>& lines, const std::string& words) {
  return std::ranges::any_of(lines, [&](const std::string& s) { return s.find(words) != std::string::npos; });
}

TEST(Topology, TetrahedronIsClosedWithItsVolume) {
  const MeshTopology t = analyseMesh(makeTetrahedron());
  EXPECT_TRUE(t.closed());
  EXPECT_EQ(t.inconsistent_edge_count, 0U);
  EXPECT_NEAR(t.volume, 1.0 / 6.0, 1e-12);
}

TEST(Topology, WeldsEqualPositionsAndSignedZeros) {
  Mesh soup;
  const Mesh solid = makeTetrahedron();
  for (const uvec3& t : solid.triangles) {
    const auto base = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t v : {t.x, t.y, t.z})
      soup.positions.push_back(base % 2 == 0 ? solid.positions[v] : -(-solid.positions[v] * 1.0F + 0.0F));
    soup.triangles.emplace_back(base, base + 1, base + 2);
  }
  soup.positions[0] = vec3(-0.0F, -0.0F, -0.0F);
  EXPECT_TRUE(analyseMesh(soup).closed());
}

TEST(Topology, CountsOpenNonmanifoldInconsistentAndDegenerate) {
  Mesh open = makeTetrahedron();
  open.triangles.pop_back();
  EXPECT_EQ(analyseMesh(open).open_edge_count, 3U);

  Mesh fan = makeTetrahedron();
  fan.positions.emplace_back(2, 2, 2);
  fan.triangles.emplace_back(1, 2, 4);
  EXPECT_EQ(analyseMesh(fan).nonmanifold_edge_count, 1U);
  EXPECT_EQ(analyseMesh(fan).open_edge_count, 2U);

  Mesh turned = makeTetrahedron();
  std::swap(turned.triangles[3].x, turned.triangles[3].y);
  EXPECT_EQ(analyseMesh(turned).inconsistent_edge_count, 3U);

  Mesh thin = makeTetrahedron();
  thin.triangles.emplace_back(1, 1, 2);
  EXPECT_EQ(analyseMesh(thin).degenerate_count, 1U);
  EXPECT_TRUE(analyseMesh(thin).closed());
}

TEST(Topology, CountsNormalsAgainstTheWinding) {
  Mesh mesh = makeTetrahedron();
  for (const vec3 p : mesh.positions) mesh.normals.push_back(normalize(p - vec3(0.25F)));
  EXPECT_EQ(analyseMesh(mesh).flipped_normal_count, 0U);
  for (vec3& n : mesh.normals) n = -n;
  EXPECT_EQ(analyseMesh(mesh).flipped_normal_count, 4U);
}

TEST(Topology, WindingNumberTellsInsideFromOutside) {
  const Mesh mesh = makeTetrahedron();
  EXPECT_NEAR(computeWindingNumber(mesh, {0.1, 0.1, 0.1}), 1.0, 1e-9);
  EXPECT_NEAR(computeWindingNumber(mesh, {0.5, 0.5, 0.5}), 0.0, 1e-9);
}

TEST(Report, GoodSceneNeedsNoDiagnosis) {
  const SceneReport report = inspectScene(makeScene(makeGlass()));
  EXPECT_TRUE(report.diagnosis.empty());
  EXPECT_TRUE(report.warnings.empty());
  EXPECT_FALSE(report.instances[0].inward);
}

TEST(Report, SaysThatGlassIsInsideOut) {
  Mesh mesh = makeTetrahedron();
  for (uvec3& t : mesh.triangles) std::swap(t.x, t.y);
  const SceneReport report = inspectScene(makeScene(makeGlass(), mesh));
  EXPECT_TRUE(report.instances[0].inward);
  EXPECT_LT(report.instances[0].signed_volume, 0.0);
  EXPECT_TRUE(mentions(report.warnings, "inside out"));
  EXPECT_TRUE(mentions(report.diagnosis, "faces inwards"));
}

// glTF 2.0, 3.7.4: a negative determinant reverses the winding that counts as the front, so that the solid stays
// outward.
TEST(Report, MirroredInstanceIsNotInsideOut) {
  SceneData scene = makeScene(makeGlass());
  scene.instances[0].world_from_object = glm::scale(mat4(1.0F), vec3(-2, 1, 1));
  const SceneReport report = inspectScene(scene);
  EXPECT_FALSE(report.instances[0].inward);
  EXPECT_NEAR(report.instances[0].signed_volume, 2.0 / 6.0, 1e-9);
  EXPECT_EQ(report.instances[0].bounds.lower.x, -2.0F);
}

TEST(Report, NotesOpenGlassAsAnInterface) {
  Mesh mesh = makeTetrahedron();
  mesh.triangles.pop_back();
  EXPECT_TRUE(mentions(inspectScene(makeScene(makeGlass(), mesh)).warnings, "open interface"));
}

TEST(Report, ExplainsThinGlassAndHowToCureIt) {
  Material pane = makeGlass();
  pane.thickness = 0;
  const SceneReport report = inspectScene(makeScene(pane));
  EXPECT_TRUE(mentions(report.diagnosis, "no generator"));
  EXPECT_TRUE(mentions(report.diagnosis, "thickness is 0"));
  EXPECT_TRUE(mentions(report.diagnosis, "--material 'glass:thickness=1'"));
}

TEST(Report, ExplainsRoughMetalWithItsNumbers) {
  Material metal;
  metal.name = "steel";
  metal.metallic = 1;
  metal.roughness = 0.6F;
  const SceneReport report = inspectScene(makeScene(metal));
  EXPECT_TRUE(mentions(report.diagnosis, "too rough: alpha 0.36 (roughness 0.6) is not below 0.25"));
  EXPECT_FALSE(mentions(inspectScene(makeScene(metal), 0.5F).diagnosis, "too rough"));
}

TEST(Report, ExplainsWeakAndSwitchedOffGenerators) {
  Material varnish;
  varnish.name = "varnish";
  varnish.roughness = 0;
  EXPECT_TRUE(mentions(inspectScene(makeScene(varnish)).diagnosis, "specular albedo 0.04, not above 0.1"));
  SceneData scene = makeScene(makeGlass());
  scene.instances[0].casts = false;
  EXPECT_TRUE(mentions(inspectScene(scene).diagnosis, "switched off"));
}

TEST(Report, NamesTheNearestCandidateWhereNothingIsShiny) {
  Material clay;
  clay.name = "clay";
  clay.roughness = 1;
  const SceneReport report = inspectScene(makeScene(clay));
  EXPECT_TRUE(mentions(report.diagnosis, "no generator"));
  EXPECT_TRUE(mentions(report.diagnosis, "material 'clay'"));
}

TEST(Report, MissesReceiverAndLight) {
  SceneData scene = makeScene(makeGlass());
  scene.instances.pop_back();
  scene.lights.clear();
  const SceneReport report = inspectScene(scene);
  EXPECT_TRUE(mentions(report.diagnosis, "no receiver"));
  EXPECT_TRUE(mentions(report.diagnosis, "no light"));
}

TEST(Report, FindsALightInsideAnObject) {
  SceneData scene = makeScene(makeGlass());
  scene.instances[0].world_from_object = glm::translate(mat4(1.0F), vec3(10, 0, 0));
  Light lamp;
  lamp.name = "lamp";
  lamp.position = {10.1F, 0.1F, 0.1F};
  scene.lights = {lamp};
  EXPECT_TRUE(mentions(inspectScene(scene).diagnosis, "light 'lamp' is inside 'thing'"));
  scene.lights[0].position = {10.6F, 0.6F, 0.6F};
  EXPECT_TRUE(inspectScene(scene).diagnosis.empty());
}

TEST(Report, TextAndJsonSayTheSame) {
  SceneData scene = buildBuiltinScene("cube", 0);
  scene.warnings.push_back("odd \xff name");
  const SceneReport report = inspectScene(scene);
  const std::string text = formatReport(scene, report);
  EXPECT_NE(text.find("cube (material cube)"), std::string::npos) << text;
  EXPECT_NE(text.find("generator"), std::string::npos);
  const nlohmann::json json = nlohmann::json::parse(formatReportJson(scene, report));
  EXPECT_EQ(json["scene"], "builtin:cube");
  EXPECT_EQ(json["triangles"], scene.triangleCount());
  ASSERT_EQ(json["objects"].size(), 2U);
  EXPECT_EQ(json["objects"][1]["name"], "cube");
  EXPECT_EQ(json["objects"][1]["openEdges"], 0);
  EXPECT_NEAR(json["objects"][1]["volume"].get<double>(), 0.06 * 0.06 * 0.06, 1e-9);
  EXPECT_TRUE(json["objects"][1]["classification"]["generator"].get<bool>());
  EXPECT_TRUE(json["materials"][1]["attenuationDistance"].is_null());
  EXPECT_EQ(json["warnings"].size(), 1U);
}

}  // namespace
}  // namespace nephroid
