// What a file needs so that it can be rendered, and does not bring along.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/classify.h"
#include "scene/directions.h"
#include "scene/load.h"

namespace nephroid {
namespace {

bool hasLight(const SceneData& scene) {
  if (!scene.lights.empty() || scene.environment) return true;
  return std::ranges::any_of(scene.instances, [&](const Instance& i) { return scene.materialOf(i).emits(); });
}

bool hasReceiver(const SceneData& scene) {
  // Each material is judged once at most, and none after the first that receives: it may have large textures.
  std::vector<bool> is_known(scene.materials.size());
  return std::ranges::any_of(scene.instances, [&](const Instance& instance) {
    const std::uint32_t material = scene.meshes[instance.mesh].material;
    if (is_known[material]) return false;
    is_known[material] = true;
    return classify(scene, scene.materials[material]).is_receiver;
  });
}

void addSun(SceneData& scene) {
  constexpr float kElevation = 45.0F, kAzimuth = 30.0F, kIrradiance = 10.0F;
  Light sun;
  sun.name = "sun";
  sun.kind = LightKind::kSun;
  sun.direction = -directionTowards(kAzimuth, kElevation);
  sun.intensity = vec3(kIrradiance);
  scene.lights.push_back(sun);
  scene.warnings.push_back(fmt::format("no light: added a sun, elevation {:g} deg, azimuth {:g} deg, {:g} W/m^2",
                                       kElevation, kAzimuth, kIrradiance));
}

/// Index at which a material of this name is not yet taken; a scene may have a "floor" of its own.
std::string findFreeName(const SceneData& scene, std::string name) {
  const auto taken = [&](const std::string& candidate) {
    return std::ranges::any_of(scene.materials, [&](const Material& m) { return m.name == candidate; }) ||
           std::ranges::any_of(scene.instances, [&](const Instance& i) { return i.name == candidate; });
  };
  std::string free = name;
  for (int i = 2; taken(free); ++i) free = fmt::format("{} {}", name, i);
  return free;
}

void addFloorBelow(SceneData& scene, const Bounds& bounds, const std::string& cause) {
  const float radius = bounds.radius() > 0.0F ? bounds.radius() : 1.0F;
  // Wide enough for the shadow and caustic of a light at 20 degrees. A little lower than the lowest point: a model with
  // a flat foot would otherwise have two surfaces in one place.
  const float half = 4.0F * radius, y = (bounds.empty() ? 0.0F : bounds.lower.y) - 1e-3F * radius;
  const vec3 centre = bounds.empty() ? vec3(0) : bounds.centre();
  Material material;
  material.name = findFreeName(scene, "floor");
  material.base_color = vec4(0.7F, 0.7F, 0.7F, 1.0F);
  material.roughness = 1.0F;
  material.specular_factor = 0.0F;
  Mesh mesh;
  mesh.name = material.name;
  mesh.material = static_cast<std::uint32_t>(scene.materials.size());
  mesh.positions = {{centre.x - half, y, centre.z + half},
                    {centre.x + half, y, centre.z + half},
                    {centre.x + half, y, centre.z - half},
                    {centre.x - half, y, centre.z - half}};
  mesh.normals.assign(4, vec3(0, 1, 0));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  Instance instance;
  instance.name = material.name;
  instance.mesh = static_cast<std::uint32_t>(scene.meshes.size());
  for (const Instance& other : scene.instances) instance.object = std::max(instance.object, other.object + 1);
  scene.materials.push_back(std::move(material));
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back(std::move(instance));
  scene.warnings.push_back(
      fmt::format("{}: added a floor of {:.4g} m at height {:.4g} m, albedo 0.7", cause, 2 * half, y));
}

/// A camera in front of, to the right of and above `bounds`, far enough to see all of it in a square picture.
void addCameraAround(SceneData& scene, const Bounds& bounds, bool with_floor) {
  constexpr float kFieldOfView = 40.0F;
  const float radius = bounds.radius() > 0.0F ? bounds.radius() : 1.0F;
  const vec3 centre = bounds.empty() ? vec3(0) : bounds.centre();
  // The caustic lies beside the object: with a floor of ours leave it the room.
  const float margin = with_floor ? 1.6F : 1.1F;
  const float distance = margin * radius / std::sin(radians(0.5F * kFieldOfView));
  const vec3 eye = centre + directionTowards(20.0F, 28.0F) * distance;
  scene.cameras.push_back(makeCamera("framing", eye, centre, radians(kFieldOfView)));
  scene.warnings.push_back("no camera: added one that frames everything");
}

}  // namespace

void completeScene(SceneData& scene, FloorMode floor) {
  const Bounds bounds = scene.bounds();
  if (!hasLight(scene)) addSun(scene);
  const bool floor_is_wanted = floor == FloorMode::kOn || (floor == FloorMode::kAuto && !hasReceiver(scene));
  if (floor_is_wanted) addFloorBelow(scene, bounds, floor == FloorMode::kOn ? "asked for" : "nothing receives light");
  if (scene.cameras.empty()) addCameraAround(scene, bounds, floor_is_wanted);
}

}  // namespace nephroid
