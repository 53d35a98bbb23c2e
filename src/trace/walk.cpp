#include "trace/walk.h"

namespace nephroid {
namespace {

/// Straight steps through holes and hidden interfaces before a path is given up; no scene has as many in a row.
constexpr int kMaxStraightSteps = 256;

}  // namespace

void Walker::advance(PathState& state, Sampler& sampler, Encounter& e, bool coherent) const {
  e.hit = e.overflow = false;
  e.transmittance = vec3(1.0F);
  e.distance = 0.0F;
  e.rays = 0;
  for (int step = 0; step < kMaxStraightSteps; ++step) {
    RayHit hit;
    ++e.rays;
    if (!scene_.intersect(state.ray, hit, coherent)) {
      if (const Material* medium = state.interior.medium()) e.transmittance *= transmittance(medium->sigmaA(), kInfinity);
      e.distance = kInfinity;
      return;
    }
    e.point = scene_.surfaceAt(state.ray, hit);
    e.distance += hit.t;
    e.material = &materials_.at(e.point, e.scratch);
    const Material& material = *e.material->source;
    const bool entering = dot(state.ray.dir, e.point.normal_geometric) < 0.0F;
    const Material* medium = state.interior.medium();
    if (e.material->is_solid) {
      const std::uint32_t solid = scene_.solidOf(hit.instance);
      e.boundary = findInterface(state.interior, solid, material, entering);
      // Met from the inside without having entered: the way here was inside.
      if (!entering && !state.interior.contains(solid)) medium = &material;
    } else {
      e.boundary = Interface{medium, medium, entering, true};
    }
    if (medium) e.transmittance *= transmittance(medium->sigmaA(), hit.t);

    bool straight = false;
    if (e.material->coverage < 1.0F)
      straight = e.material->coverage == 0.0F || sampler.next1D() >= e.material->coverage;
    if (!straight && e.material->is_solid && !e.boundary.is_event) {
      straight = true;
      if (!crossInterface(state.interior, scene_.solidOf(hit.instance), material, entering)) {
        e.overflow = true;
        return;
      }
    }
    if (!straight) {
      e.hit = true;
      return;
    }
    state.ray.origin = offsetOrigin(e.point, state.ray.dir);
  }
  e.overflow = true;
}

vec3 Walker::visibility(const Ray& ray, const Material* medium, std::uint64_t& ray_count) const {
  vec3 visible = medium ? transmittance(medium->sigmaA(), ray.t_max) : vec3(1.0F);
  if (maxComponent(visible) == 0.0F) return vec3(0.0F);
  if (!materials_.anyPassable()) {
    ++ray_count;
    return scene_.occluded(ray) ? vec3(0.0F) : visible;
  }
  Ray rest = ray;
  SurfaceMaterial scratch;
  for (int step = 0; step < kMaxStraightSteps; ++step) {
    RayHit hit;
    ++ray_count;
    if (!scene_.intersect(rest, hit)) return visible;
    const SurfacePoint point = scene_.surfaceAt(rest, hit);
    const float cos_theta = std::abs(dot(rest.dir, point.normal_shading));
    visible *= passTransmittance(materials_.at(point, scratch), cos_theta, medium ? medium->ior : 1.0F);
    if (maxComponent(visible) == 0.0F) return vec3(0.0F);
    rest.origin = offsetOrigin(point, rest.dir);
    if (std::isfinite(rest.t_max)) rest.t_max = std::max(rest.t_max - hit.t, 0.0F);
  }
  return vec3(0.0F);
}

}  // namespace nephroid
