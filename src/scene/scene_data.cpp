#include "scene/scene_data.h"

#include <algorithm>
#include <cmath>

namespace nephroid {

/// A colour of 0 would need an infinite coefficient, and infinity times a distance of 0 is not a number; the smallest
/// normal float stands for it (87 e-foldings per attenuation distance). A distance that is not above 0 absorbs nothing,
/// as one that is infinite.
vec3 Material::sigmaA() const {
  if (!(attenuation_distance > 0.0F)) return vec3(0.0F);
  vec3 sigma_a_per_m;
  for (int c = 0; c < 3; ++c) {
    const float color = std::clamp(attenuation_color[c], std::numeric_limits<float>::min(), 1.0F);
    // "0 -" and not a bare minus: white gives 0, not -0.
    const float sigma = (0.0F - std::log(color)) / attenuation_distance;
    sigma_a_per_m[c] = std::min(sigma, std::numeric_limits<float>::max());
  }
  return sigma_a_per_m;
}

Bounds Mesh::bounds() const {
  Bounds bounds;
  for (const vec3& position : positions) bounds.add(position);
  return bounds;
}

Bounds SceneData::bounds() const {
  Bounds bounds;
  for (const Instance& instance : instances)
    for (const vec3& position : meshes[instance.mesh].positions)
      bounds.add(transformPoint(instance.world_from_object, position));
  return bounds;
}

std::size_t SceneData::triangleCount() const {
  std::size_t count = 0;
  for (const Instance& instance : instances) count += meshes[instance.mesh].triangles.size();
  return count;
}

Camera makeCamera(std::string name, vec3 eye, vec3 target, float fov_y, float ortho_height) {
  Camera camera;
  camera.name = std::move(name);
  camera.eye = eye;
  camera.fov_y = fov_y;
  camera.ortho_height = ortho_height;
  const vec3 towards = target - eye;
  if (length(towards) > 0.0F) camera.forward = normalize(towards);
  // Straight up or down +Y gives no direction across the view; -Z does, and is what a map's north would be.
  const bool is_vertical = std::abs(camera.forward.y) > 0.9999F;
  const vec3 upright = is_vertical ? vec3(0, 0, -1) : vec3(0, 1, 0);
  camera.up = normalize(upright - dot(upright, camera.forward) * camera.forward);
  return camera;
}

}  // namespace nephroid
