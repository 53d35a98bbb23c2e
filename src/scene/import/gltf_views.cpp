#include "scene/import/gltf_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "scene/import/gltf_value.h"

namespace nephroid::gltf {
namespace {

/// A node's axes in the world, unit; scale and mirroring removed as far as directions go.
struct Pose {
  vec3 position, forward, up;
};

/// @return nothing where a scale of zero leaves no direction
std::optional<Pose> findPose(const mat4& world) {
  const vec3 forward = transformVector(world, {0, 0, -1}), up = transformVector(world, {0, 1, 0});
  if (!(length(forward) > 0) || !(length(up) > 0)) return std::nullopt;
  Pose pose{vec3(world[3]), normalize(forward), vec3(0)};
  const vec3 upright = normalize(up) - dot(normalize(up), pose.forward) * pose.forward;
  if (!(length(upright) > 1e-4F) || !isFinite(pose.forward)) return std::nullopt;
  pose.up = normalize(upright);
  return pose;
}

std::string nameOf(const std::string& node, const std::string& thing, std::string_view array, std::size_t index) {
  if (!node.empty()) return cleanName(node);
  return thing.empty() ? placeOf(array, index) : cleanName(thing);
}

Camera makeCameraFrom(const Document& document, const tinygltf::Camera& source, const Pose& pose,
                      const std::string& place) {
  Camera camera;
  camera.eye = pose.position;
  camera.forward = pose.forward;
  camera.up = pose.up;
  if (source.type == "orthographic") {
    camera.ortho_height = 2 * std::abs(static_cast<float>(source.orthographic.ymag));
    if (!(camera.ortho_height > 0) || !std::isfinite(camera.ortho_height))
      document.fail(place, fmt::format("ymag {} is not a size", source.orthographic.ymag));
    return camera;
  }
  if (source.type != "perspective")
    document.fail(place,
                  fmt::format("type '{}' is unknown, expected perspective or orthographic", cleanName(source.type)));
  camera.fov_y = static_cast<float>(source.perspective.yfov);
  if (!(camera.fov_y > 0 && camera.fov_y < kPi))
    document.fail(place, fmt::format("yfov {} is not in (0, pi)", source.perspective.yfov));
  return camera;
}

class LightReader {
 public:
  LightReader(Document& document, const tinygltf::Light& source, std::string place)
      : document_(document), source_(source), place_(std::move(place)) {}

  /// @return nothing for a type that some extension may add
  std::optional<Light> read() {
    if (source_.type == "point") {
      light_.kind = LightKind::kPoint;
    } else if (source_.type == "spot") {
      light_.kind = LightKind::kSpot;
    } else if (source_.type == "directional") {
      light_.kind = LightKind::kSun;
    } else {
      document_.warn(place_, fmt::format("type '{}' is unknown; the light is ignored", cleanName(source_.type)));
      return std::nullopt;
    }
    readIntensity();
    if (light_.kind == LightKind::kSpot) readCone();
    light_.radius = readSize("radius", light_.kind != LightKind::kSun, kInfinity);
    light_.angle_deg = readSize("angle", light_.kind == LightKind::kSun, 180.0F);
    if (source_.range > 0) document_.warn(place_, "range is ignored: light does not end at a distance");
    return light_;
  }

 private:
  void readIntensity() {
    vec3 color(1.0F);
    for (int c = 0; c < 3 && source_.color.size() == 3; ++c)
      color[c] = static_cast<float>(source_.color[static_cast<std::size_t>(c)]);
    light_.intensity = static_cast<float>(source_.intensity) * color;
    if (!isFinite(light_.intensity)) document_.fail(place_, "intensity times color is not finite");
    if (minComponent(light_.intensity) >= 0) return;
    document_.warn(place_, "intensity or color is negative; 0 is used");
    light_.intensity = glm::max(light_.intensity, vec3(0));
  }

  void readCone() {
    const auto outer = static_cast<float>(source_.spot.outerConeAngle);
    const auto inner = static_cast<float>(source_.spot.innerConeAngle);
    light_.outer_cone = std::clamp(outer, 1e-4F, kPi / 2);
    light_.inner_cone = std::clamp(inner, 0.0F, light_.outer_cone);
    if (light_.outer_cone != outer || light_.inner_cone != inner)
      document_.warn(place_,
                     fmt::format("cone angles {} and {} are not 0 <= inner <= outer <= pi/2; {} and {} are used", inner,
                                 outer, light_.inner_cone, light_.outer_cone));
  }

  /// `extras.NAME`, 0 where absent or wrong.
  float readSize(const char* name, bool applies, float upper) {
    if (!isPresent(getMember(source_.extras, name))) return 0;
    const float size = getFloat(source_.extras, name, -1);
    if (applies && size >= 0 && size <= upper) return size;
    document_.warn(place_, fmt::format("extras.{} does not suit this light or is out of range; ignored", name));
    return 0;
  }

  Document& document_;
  const tinygltf::Light& source_;
  std::string place_;
  Light light_;
};

}  // namespace

void readCameras(Document& document, const NodeGraph& graph, SceneData& scene) {
  const tinygltf::Model& model = document.model;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    if (!graph.in_scene[i] || model.nodes[i].camera < 0) continue;
    const auto index = static_cast<std::size_t>(model.nodes[i].camera);
    const std::string place = placeOf("nodes", i, model.nodes[i].name);
    if (index >= model.cameras.size())
      document.fail(place, fmt::format("camera {} does not exist; the file has {}", index, model.cameras.size()));
    const auto pose = findPose(graph.world_from_node[i]);
    if (!pose) {
      document.warn(place, "its camera has no direction (scale 0?) and is ignored");
      continue;
    }
    scene.cameras.push_back(makeCameraFrom(document, model.cameras[index], *pose, placeOf("cameras", index)));
    scene.cameras.back().name = nameOf(model.nodes[i].name, model.cameras[index].name, "cameras", index);
  }
}

void readLights(Document& document, const NodeGraph& graph, SceneData& scene) {
  const tinygltf::Model& model = document.model;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const tinygltf::Value& extension = getExtension(model.nodes[i].extensions, "KHR_lights_punctual");
    if (!graph.in_scene[i] || !isPresent(extension)) continue;
    const int light_index = getInt(extension, "light", -1);
    const std::string place = placeOf("nodes", i, model.nodes[i].name);
    if (light_index < 0 || static_cast<std::size_t>(light_index) >= model.lights.size())
      document.fail(place, fmt::format("light {} does not exist; the file has {}", light_index, model.lights.size()));
    const auto index = static_cast<std::size_t>(light_index);
    const auto pose = findPose(graph.world_from_node[i]);
    if (!pose) {
      document.warn(place, "its light has no direction (scale 0?) and is ignored");
      continue;
    }
    auto light = LightReader(document, model.lights[index], placeOf("lights", index, model.lights[index].name)).read();
    if (!light) continue;
    light->name = nameOf(model.nodes[i].name, model.lights[index].name, "lights", index);
    light->position = pose->position;
    light->direction = pose->forward;
    scene.lights.push_back(std::move(*light));
  }
}

}  // namespace nephroid::gltf
