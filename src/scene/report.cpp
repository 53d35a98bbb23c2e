// Looks at a scene as light transport will, and says what it finds.
#include "scene/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "scene/mesh_topology.h"

namespace nephroid {
namespace {

InstanceReport inspectInstance(const SceneData& scene, const Instance& instance, const MeshTopology& topology,
                               const Classification& classification) {
  const Mesh& mesh = scene.meshes[instance.mesh];
  InstanceReport report;
  report.name = instance.name;
  report.material = scene.materialOf(instance).name;
  report.triangle_count = mesh.triangles.size();
  report.open_edge_count = topology.open_edge_count;
  report.nonmanifold_edge_count = topology.nonmanifold_edge_count;
  report.inconsistent_edge_count = topology.inconsistent_edge_count;
  report.degenerate_count = topology.degenerate_count;
  report.flipped_normal_count = topology.flipped_normal_count;
  // A mirrored instance is wound the other way round in the world, and read the other way round too (glTF 2.0, 3.7.4):
  // its volume keeps the sign that it has in object space.
  const double scale = std::abs(static_cast<double>(glm::determinant(mat3(instance.world_from_object))));
  report.signed_volume = topology.volume * scale;
  report.inward = topology.closed() && !mesh.triangles.empty() && topology.volume < 0.0;
  for (const vec3 p : mesh.positions) report.bounds.add(transformPoint(instance.world_from_object, p));
  report.classification = classification;
  return report;
}

// --- warnings that follow from the geometry -----------------------------------------------------------------------

void warnOfGeometry(const InstanceReport& r, const Material& material, std::vector<std::string>& warnings) {
  const auto warn = [&](std::string text) { warnings.push_back(fmt::format("'{}': {}", r.name, text)); };
  const bool solid = material.isSolidDielectric();
  if (r.triangle_count == 0) warn("has no triangles");
  if (solid && r.inward)
    warn(fmt::format(
        "solid glass turned inside out: it is closed, but its triangles face inwards (volume {:.3g} m^3), so light "
        "would refract the wrong way at every surface; flip its faces",
        r.signed_volume));
  else if (r.inward)
    warn(fmt::format("is closed, but its triangles face inwards (volume {:.3g} m^3)", r.signed_volume));
  if (solid && r.open_edge_count > 0)
    warn(fmt::format(
        "solid glass or water with {} open edges: treated as an open interface, like a water surface; if it is meant "
        "to be a closed solid, close it",
        r.open_edge_count));
  if (r.nonmanifold_edge_count > 0)
    warn(fmt::format("{} edges have more than two triangles", r.nonmanifold_edge_count));
  if (r.inconsistent_edge_count > 0)
    warn(fmt::format("{} edges join triangles that are wound in opposite senses", r.inconsistent_edge_count));
  if (r.flipped_normal_count > 0)
    warn(fmt::format("{} of {} triangles have vertex normals against their winding", r.flipped_normal_count,
                     r.triangle_count));
  if (r.degenerate_count > 0) warn(fmt::format("{} triangles have no area", r.degenerate_count));
}

// --- diagnosis ----------------------------------------------------------------------------------------------------

bool isGenerator(const SceneData& scene, std::size_t i, const SceneReport& report) {
  return scene.instances[i].casts && report.instances[i].classification.is_generator &&
         report.instances[i].triangle_count > 0;
}

/// Why a material that looks like glass or metal does not cast, and what would change that. Empty: nothing of the kind.
std::string explainNoCaster(const Instance& instance, const Material& m, const Classification& c,
                            float specular_alpha) {
  if (!instance.casts && c.is_generator)
    return fmt::format("'{}' would cast, but is switched off; --object '{}:cast=true'", instance.name, instance.name);
  if (c.is_generator) return {};
  const float limit = std::sqrt(specular_alpha);
  if (m.transmits() && m.metallic < 1.0F && m.thickness <= 0.0F)
    return fmt::format(
        "'{}' (material '{}') casts no caustic because its thickness is 0: a thin pane does not bend light; for solid "
        "glass set "
        "--material '{}:thickness=1'{}",
        instance.name, m.name, m.name,
        c.alpha >= specular_alpha ? fmt::format(" and roughness below {:.3g}", limit) : "");
  if ((m.transmits() || m.metallic > kGeneratorAlbedo) && c.alpha >= specular_alpha)
    return fmt::format(
        "'{}' (material '{}') is too rough: alpha {:.3g} (roughness {:.3g}) is not below {:.3g}; set --material "
        "'{}:roughness=0' or raise specular-alpha",
        instance.name, m.name, c.alpha, m.roughness, specular_alpha, m.name);
  if (c.is_weak_generator)
    return fmt::format(
        "'{}' (material '{}') reflects too little: specular albedo {:.3g}, not above {:.3g}; it casts only with --set "
        "weak-generators=true",
        instance.name, m.name, c.specular_albedo, kGeneratorAlbedo);
  return {};
}

void diagnoseGenerators(const SceneData& scene, SceneReport& report, float specular_alpha) {
  bool any = false;
  std::vector<std::string> reasons;
  std::size_t nearest = report.instances.size();
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    any = any || isGenerator(scene, i, report);
    const Material& material = scene.materialOf(scene.instances[i]);
    const Classification& c = report.instances[i].classification;
    std::string reason = explainNoCaster(scene.instances[i], material, c, specular_alpha);
    if (!reason.empty() && std::ranges::find(reasons, reason) == reasons.end()) reasons.push_back(std::move(reason));
    if (nearest == report.instances.size() || material.roughness < scene.materialOf(scene.instances[nearest]).roughness)
      nearest = i;
  }
  if (!any && reasons.empty() && nearest < report.instances.size())
    reasons.push_back(fmt::format("the nearest to it is '{}' (material '{}'): {}", report.instances[nearest].name,
                                  report.instances[nearest].material, report.instances[nearest].classification.reason));
  if (!any)
    report.diagnosis.emplace_back(
        "no generator: nothing mirrors or refracts light, so there is no caustic; glass needs transmission > 0, "
        "thickness > 0 and "
        "low roughness, metal needs metallic = 1 and low roughness");
  // A varnish beside real glass is nothing to worry people with; a pane or a switched-off object may be.
  constexpr std::size_t kMostReasons = 8;
  for (std::size_t i = 0; i < std::min(reasons.size(), kMostReasons); ++i)
    if (!any || reasons[i].find("reflects too little") == std::string::npos) report.diagnosis.push_back(reasons[i]);
  if (reasons.size() > kMostReasons)
    report.diagnosis.push_back(fmt::format("… and {} more of the kind", reasons.size() - kMostReasons));
}

void diagnoseReceivers(const SceneReport& report, std::vector<std::string>& diagnosis) {
  const bool any = std::ranges::any_of(
      report.instances, [](const InstanceReport& r) { return r.classification.is_receiver && r.triangle_count > 0; });
  if (!any)
    diagnosis.emplace_back(
        "no receiver: nothing scatters light diffusely, so no caustic can be seen; add a floor (--floor on)");
}

void diagnoseLights(const SceneData& scene, std::vector<std::string>& diagnosis) {
  const bool emissive =
      std::ranges::any_of(scene.instances, [&](const Instance& i) { return scene.materialOf(i).emits(); });
  if (scene.lights.empty() && !scene.environment && !emissive)
    diagnosis.emplace_back(
        "no light: neither lamps nor emissive surfaces nor an environment; add one (--light sun:elevation=45 or --env "
        "sky)");
  for (const Light& light : scene.lights) {
    if (maxComponent(light.intensity) <= 0.0F)
      diagnosis.push_back(fmt::format("light '{}' is black: its intensity is 0", light.name));
    if (light.kind == LightKind::kSun && light.direction.y >= 0.0F)
      diagnosis.push_back(fmt::format("light '{}' is a sun below the horizon: floors get nothing from it", light.name));
  }
}

/// Names the closed objects that a point or spot light is inside of.
void diagnoseEnclosedLights(const SceneData& scene, SceneReport& report) {
  for (const Light& light : scene.lights) {
    if (light.kind == LightKind::kSun) continue;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
      const InstanceReport& r = report.instances[i];
      const vec3 p = light.position;
      const bool in_box =
          glm::all(glm::lessThanEqual(r.bounds.lower, p)) && glm::all(glm::lessThanEqual(p, r.bounds.upper));
      if (!in_box || r.open_edge_count > 0 || r.nonmanifold_edge_count > 0) continue;
      const glm::dmat4 object_from_world = glm::inverse(glm::dmat4(scene.instances[i].world_from_object));
      const dvec3 local(object_from_world * glm::dvec4(dvec3(p), 1.0));
      if (std::abs(computeWindingNumber(scene.meshes[scene.instances[i].mesh], local)) < 0.5) continue;
      const bool glass = scene.materialOf(scene.instances[i]).isSolidDielectric();
      report.diagnosis.push_back(fmt::format("light '{}' is inside '{}': {}", light.name, r.name,
                                             glass ? "it shines from within the glass" : "its light does not get out"));
    }
  }
}

void diagnoseGlass(const SceneData& scene, SceneReport& report) {
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Material& m = scene.materialOf(scene.instances[i]);
    if (m.isSolidDielectric() && report.instances[i].inward)
      report.diagnosis.push_back(
          fmt::format("'{}' is glass with its faces inwards: its caustic will be wrong", scene.instances[i].name));
    if (m.isSolidDielectric() && m.ior == 1.0F)
      report.diagnosis.push_back(fmt::format("'{}' has ior 1: it does not bend light (--material '{}:ior=1.5')",
                                             scene.instances[i].name, m.name));
  }
}

}  // namespace

SceneReport inspectScene(const SceneData& scene, float specular_alpha) {
  const std::vector<Classification> classes = classifyMaterials(scene, specular_alpha);
  std::vector<MeshTopology> topologies;
  for (const Mesh& mesh : scene.meshes) topologies.push_back(analyseMesh(mesh));
  SceneReport report;
  report.warnings = scene.warnings;
  for (const Instance& instance : scene.instances) {
    const std::uint32_t material = scene.meshes[instance.mesh].material;
    report.instances.push_back(inspectInstance(scene, instance, topologies[instance.mesh], classes[material]));
    warnOfGeometry(report.instances.back(), scene.materials[material], report.warnings);
  }
  diagnoseGenerators(scene, report, specular_alpha);
  diagnoseReceivers(report, report.diagnosis);
  diagnoseLights(scene, report.diagnosis);
  diagnoseEnclosedLights(scene, report);
  diagnoseGlass(scene, report);
  return report;
}

}  // namespace nephroid
