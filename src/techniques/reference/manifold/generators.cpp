#include "techniques/reference/manifold/generators.h"

#include "core/sampling/warp.h"

namespace nephroid {

GeneratorSurfaces::GeneratorSurfaces(const TraceScene& scene, const std::vector<bool>& wanted)
    : scene_(scene), scale_of_instance_(wanted.size(), 0.0F) {
  std::vector<float> areas;
  for (std::uint32_t instance = 0; instance < wanted.size(); ++instance) {
    if (!wanted[instance]) continue;
    Bounds bounds;
    for (std::uint32_t t = 0; t < scene.triangleCountOf(instance); ++t) {
      vec3 p[3];
      scene.triangleCorners(instance, t, p);
      for (const vec3& corner : p) bounds.add(corner);
      triangles_.push_back({instance, t});
      areas.push_back(0.5F * length(cross(p[1] - p[0], p[2] - p[0])));
    }
    scale_of_instance_[instance] = bounds.radius();
  }
  if (!areas.empty()) by_area_.emplace(areas);
}

vec3 GeneratorSurfaces::sample(Sampler& sampler) const {
  const float u_triangle = sampler.next1D();
  const vec3 weights = sampleUniformTriangle(sampler.next2D());
  const Triangle& triangle = triangles_[by_area_->sample(u_triangle).index];
  vec3 p[3];
  scene_.triangleCorners(triangle.instance, triangle.index, p);
  return weights.x * p[0] + weights.y * p[1] + weights.z * p[2];
}

}  // namespace nephroid
