// Scenes of a few lines for tests of transport: everything in view, nothing left to chance.
#pragma once

#include <cmath>
#include <utility>

#include "scene/builtin/shapes.h"
#include "scene/scene_data.h"
#include "techniques/technique.h"

namespace nephroid::test {

inline Material makeDiffuse(vec3 albedo) {
  Material m;
  m.name = "diffuse";
  m.base_color = vec4(albedo, 1.0F);
  return m;
}

inline Material makeGlass(float ior, float roughness = 0.0F) {
  Material m;
  m.name = "glass";
  m.roughness = roughness;
  m.transmission = 1.0F;
  m.ior = ior;
  m.thickness = 1.0F;
  return m;
}

inline Material makeMetal(vec3 color, float roughness = 0.0F) {
  Material m;
  m.name = "metal";
  m.base_color = vec4(color, 1.0F);
  m.metallic = 1.0F;
  m.roughness = roughness;
  return m;
}

/// Mirrors half of all light and scatters the other half, at any angle.
inline Material makeHalfMirror() {
  Material m = makeMetal(vec3(1.0F));
  m.name = "half mirror";
  m.metallic = 0.5F;
  m.specular_factor = 0.0F;
  return m;
}

/// Adds a mesh with its own material and one instance of it. @return the instance's index
inline std::uint32_t addObject(SceneData& scene, Mesh mesh, Material material, mat4 placed = mat4(1.0F)) {
  mesh.material = static_cast<std::uint32_t>(scene.materials.size());
  scene.materials.push_back(std::move(material));
  Instance instance;
  instance.name = mesh.name;
  instance.mesh = static_cast<std::uint32_t>(scene.meshes.size());
  instance.object = static_cast<std::uint32_t>(scene.instances.size());
  instance.world_from_object = placed;
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back(std::move(instance));
  return static_cast<std::uint32_t>(scene.instances.size() - 1);
}

inline Light makeSun(vec3 direction, vec3 irradiance, float angle_deg = 0.0F) {
  Light light;
  light.name = "sun";
  light.kind = LightKind::kSun;
  light.direction = normalize(direction);
  light.intensity = irradiance;
  light.angle_deg = angle_deg;
  return light;
}

inline Light makePoint(vec3 position, vec3 intensity, float radius = 0.0F) {
  Light light;
  light.name = "point";
  light.position = position;
  light.intensity = intensity;
  light.radius = radius;
  return light;
}

inline Mesh makeFloor(double size, double y = 0.0) {
  return makeRectangle("floor", dvec3(0, y, 0), dvec3(0, 0, 0.5 * size), dvec3(0.5 * size, 0, 0));
}

/// A ball of `material`, radius 1, its centre at (0, 1.2, 0), over a floor of albedo 0.6 and 8 m.
inline SceneData makeBallScene(Material material, int segments = 96) {
  SceneData scene;
  scene.name = "ball";
  addObject(scene, makeFloor(8.0), makeDiffuse(vec3(0.6F)));
  addObject(scene, makeSphere("ball", dvec3(0, 1.2, 0), 1.0, segments), std::move(material));
  return scene;
}

/// Settings of the reference for a small picture.
inline RenderSettings makeSettings(int size, std::uint64_t samples, std::uint64_t photons,
                                   std::vector<std::string> layers) {
  RenderSettings settings;
  settings.width = settings.height = size;
  settings.samples = samples;
  settings.photons = photons;
  settings.layers = std::move(layers);
  settings.params = ParamSet(findTechnique("reference").params);
  return settings;
}

inline RenderResult renderReference(const SceneData& scene, const Camera& camera, const RenderSettings& settings) {
  return findTechnique("reference").render(scene, camera, settings, nullptr, nullptr);
}

/// Mean over all pixels, per channel.
inline dvec3 meanOf(const Image& image) {
  dvec3 sum(0.0);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) sum += dvec3(image.rgb(x, y));
  return sum / (static_cast<double>(image.width) * image.height);
}

/// Σ|a − b| / Σ|b| over all pixels and channels.
inline double relativeDifference(const Image& a, const Image& b) {
  double difference = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    difference += std::abs(static_cast<double>(a.pixels[i]) - b.pixels[i]);
    sum += std::abs(static_cast<double>(b.pixels[i]));
  }
  return difference / sum;
}

}  // namespace nephroid::test
