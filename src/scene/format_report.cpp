// A scene report as text for people and as JSON for programs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "scene/report.h"

namespace nephroid {
namespace {

using Json = nlohmann::ordered_json;

std::string formatVec(vec3 v) { return fmt::format("{:.4g}, {:.4g}, {:.4g}", v.x, v.y, v.z); }

const char* kindName(LightKind kind) {
  return kind == LightKind::kSun ? "sun" : kind == LightKind::kSpot ? "spot" : "point";
}

std::string describeRole(const Classification& c, bool casts) {
  std::vector<std::string> roles;
  if (c.is_generator) roles.emplace_back(casts ? "generator" : "generator (switched off)");
  if (c.is_weak_generator) roles.emplace_back("weak generator");
  if (c.is_receiver) roles.emplace_back("receiver");
  return roles.empty() ? "neither generator nor receiver" : fmt::format("{}", fmt::join(roles, " and "));
}

std::string describeShape(const InstanceReport& r) {
  const bool closed = r.open_edge_count == 0 && r.nonmanifold_edge_count == 0;
  std::string text =
      closed ? fmt::format("closed, {:.4g} m^3", r.signed_volume) : fmt::format("{} open edges", r.open_edge_count);
  if (r.inward) text += ", faces inwards";
  return text;
}

std::string formatInstance(const SceneData& scene, std::size_t i, const InstanceReport& r) {
  return fmt::format("  {} (material {})\n    {} triangles, {}; size {} m about ({})\n    {}: {}\n", r.name, r.material,
                     r.triangle_count, describeShape(r), formatVec(r.bounds.extent()),
                     formatVec(r.bounds.empty() ? vec3(0) : r.bounds.centre()),
                     describeRole(r.classification, scene.instances[i].casts), r.classification.reason);
}

std::string formatMaterial(const Material& m) {
  std::string text = fmt::format("  {}: base ({}), metallic {:.3g}, roughness {:.3g}", m.name,
                                 formatVec(vec3(m.base_color)), m.metallic, m.roughness);
  if (m.transmits())
    text += fmt::format(", transmission {:.3g}, ior {:.5g}, {}", m.transmission, m.ior,
                        m.thickness > 0 ? "solid" : "thin-walled");
  if (m.dispersion > 0) text += fmt::format(", dispersion {:.3g} (Abbe {:.3g})", m.dispersion, 20.0F / m.dispersion);
  if (std::isfinite(m.attenuation_distance))
    text += fmt::format(", attenuation ({}) at {:.3g} m", formatVec(m.attenuation_color), m.attenuation_distance);
  if (m.emits()) text += fmt::format(", emission ({}) W/m^2/sr", formatVec(m.emission));
  if (m.priority != 0) text += fmt::format(", priority {}", m.priority);
  return text + "\n";
}

std::string formatLight(const Light& light) {
  const bool sun = light.kind == LightKind::kSun;
  std::string text = fmt::format("  {} ({}): ({}) {}", light.name, kindName(light.kind), formatVec(light.intensity),
                                 sun ? "W/m^2" : "W/sr");
  if (!sun) text += fmt::format(" at ({})", formatVec(light.position));
  if (light.kind != LightKind::kPoint) text += fmt::format(" towards ({})", formatVec(light.direction));
  if (sun && light.angle_deg > 0) text += fmt::format(", angle {:.3g} deg", light.angle_deg);
  if (!sun && light.radius > 0) text += fmt::format(", radius {:.3g} m", light.radius);
  return text + "\n";
}

std::string formatList(const char* title, const std::vector<std::string>& lines) {
  if (lines.empty()) return {};
  std::string text = fmt::format("{}:\n", title);
  for (const std::string& line : lines) text += fmt::format("  {}\n", line);
  return text;
}

/// JSON has no infinity: what is unbounded is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json vector(vec3 v) { return Json::array({number(v.x), number(v.y), number(v.z)}); }

Json toJson(const Classification& c) {
  return {{"alpha", c.alpha},
          {"specularAlbedo", c.specular_albedo},
          {"specularTransmission", c.specular_transmission},
          {"diffuseAlbedo", c.diffuse_albedo},
          {"generator", c.is_generator},
          {"weakGenerator", c.is_weak_generator},
          {"receiver", c.is_receiver},
          {"reason", c.reason}};
}

Json toJson(const InstanceReport& r, bool casts) {
  return {{"name", r.name},
          {"material", r.material},
          {"triangles", r.triangle_count},
          {"openEdges", r.open_edge_count},
          {"nonmanifoldEdges", r.nonmanifold_edge_count},
          {"inconsistentEdges", r.inconsistent_edge_count},
          {"degenerateTriangles", r.degenerate_count},
          {"flippedNormals", r.flipped_normal_count},
          {"inward", r.inward},
          {"volume", number(r.signed_volume)},
          {"lower", vector(r.bounds.lower)},
          {"upper", vector(r.bounds.upper)},
          {"casts", casts},
          {"classification", toJson(r.classification)}};
}

Json toJson(const Material& m) {
  return {{"name", m.name},
          {"baseColor", vector(vec3(m.base_color))},
          {"metallic", m.metallic},
          {"roughness", m.roughness},
          {"transmission", m.transmission},
          {"ior", m.ior},
          {"dispersion", m.dispersion},
          {"thickness", m.thickness},
          {"attenuationColor", vector(m.attenuation_color)},
          {"attenuationDistance", number(m.attenuation_distance)},
          {"emission", vector(m.emission)},
          {"priority", m.priority}};
}

Json toJson(const Light& light) {
  Json json{{"name", light.name}, {"kind", kindName(light.kind)}};
  const bool sun = light.kind == LightKind::kSun;
  json[sun ? "irradiance" : "intensity"] = vector(light.intensity);
  if (!sun) json["position"] = vector(light.position);
  if (light.kind != LightKind::kPoint) json["direction"] = vector(light.direction);
  json[sun ? "angle" : "radius"] = sun ? light.angle_deg : light.radius;
  return json;
}

}  // namespace

std::string formatReport(const SceneData& scene, const SceneReport& report) {
  const Bounds bounds = scene.bounds();
  std::string text = fmt::format("{}: {} triangles in {} objects, size {} m\n", scene.name, scene.triangleCount(),
                                 scene.instances.size(), formatVec(bounds.extent()));
  if (scene.duration > 0) text += fmt::format("animated: {:.4g} s\n", scene.duration);
  text += "objects:\n";
  for (std::size_t i = 0; i < report.instances.size(); ++i) text += formatInstance(scene, i, report.instances[i]);
  text += "materials:\n";
  for (const Material& material : scene.materials) text += formatMaterial(material);
  if (!scene.lights.empty()) text += "lights:\n";
  for (const Light& light : scene.lights) text += formatLight(light);
  if (scene.environment)
    text += fmt::format("environment: {}, scale {:.4g}\n", scene.environment->source, scene.environment->scale);
  if (!scene.cameras.empty()) text += "cameras:\n";
  for (const Camera& camera : scene.cameras)
    text += fmt::format("  {}: at ({}) towards ({})\n", camera.name, formatVec(camera.eye), formatVec(camera.forward));
  return text + formatList("warnings", report.warnings) + formatList("diagnosis", report.diagnosis);
}

std::string formatReportJson(const SceneData& scene, const SceneReport& report) {
  Json json{{"scene", scene.name}, {"triangles", scene.triangleCount()}, {"duration", scene.duration}};
  for (const char* key : {"objects", "materials", "lights", "cameras"}) json[key] = Json::array();
  for (std::size_t i = 0; i < report.instances.size(); ++i)
    json["objects"].push_back(toJson(report.instances[i], scene.instances[i].casts));
  for (const Material& material : scene.materials) json["materials"].push_back(toJson(material));
  for (const Light& light : scene.lights) json["lights"].push_back(toJson(light));
  for (const Camera& camera : scene.cameras)
    json["cameras"].push_back(
        {{"name", camera.name}, {"eye", vector(camera.eye)}, {"forward", vector(camera.forward)}});
  json["environment"] = scene.environment ? Json(scene.environment->source) : Json(nullptr);
  json["warnings"] = report.warnings;
  json["diagnosis"] = report.diagnosis;
  // Names in files need not be UTF-8; a report must come out all the same.
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace nephroid
