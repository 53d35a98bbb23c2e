#include "trace/walk.h"

namespace nephroid {
namespace {

/// Straight steps through holes and hidden interfaces before a path is given up; no scene has as many in a row.
constexpr std::uint32_t kMaxStraightSteps = 256;

}  // namespace

void Walker::advance(PathState& state, Sampler& sampler, Encounter& e, bool coherent) const {
  depart(e);
  RayHit hit;
  do {
    if (!scene_.intersect(state.ray, hit, coherent)) hit.instance = kNone;
  } while (!arrive(state, sampler, e, hit));
}

void Walker::depart(Encounter& e) {
  e.hit = e.overflow = false;
  e.transmittance = vec3(1.0F);
  e.distance = 0.0F;
  e.rays = 0;
}

bool Walker::arrive(PathState& state, Sampler& sampler, Encounter& e, const RayHit& hit) const {
  ++e.rays;
  const Material* medium = state.interior.medium();
  if (hit.instance == kNone) {
    e.transmittance *= transmittanceOf(medium, kInfinity);
    e.distance = kInfinity;
    return true;
  }
  scene_.describeSurface(state.ray, hit, e.point);
  e.distance += hit.t;
  e.material = &materials_.at(e.point, e.scratch);
  const Material& material = *e.material->source;
  const bool entering = dot(state.ray.dir, e.point.normal_geometric) < 0.0F;
  const std::uint32_t solid = scene_.solidOf(hit.instance);
  if (e.material->is_solid) {
    e.boundary = findInterface(state.interior, solid, material, entering);
    // Met from the inside without having entered: the way here was inside.
    if (!entering && !state.interior.contains(solid)) medium = &material;
  } else {
    e.boundary = Interface{medium, medium, entering, true};
  }
  e.transmittance *= transmittanceOf(medium, hit.t);

  bool straight = false;
  if (e.material->coverage < 1.0F) straight = e.material->coverage == 0.0F || sampler.next1D() >= e.material->coverage;
  if (!straight && e.material->is_solid && !e.boundary.is_event) {
    straight = true;
    e.overflow = !crossInterface(state.interior, solid, material, entering);
  }
  e.hit = !straight;
  if (!straight || e.overflow) return true;
  state.ray.origin = offsetOrigin(e.point, state.ray.dir);
  e.overflow = e.rays == kMaxStraightSteps;
  return e.overflow;
}

vec3 Walker::transmittanceOf(const Material* medium, float distance) const {
  if (!medium) return vec3(1.0F);
  const vec3 sigma_a = materials_.sigmaAOf(*medium);
  return sigma_a == vec3(0.0F) ? vec3(1.0F) : transmittance(sigma_a, distance);
}

void Walker::visibility(std::span<const Sightline> lines, vec3* visible, std::uint64_t& ray_count) const {
  if (materials_.anyPassable()) {
    for (std::size_t i = 0; i < lines.size(); ++i) visible[i] = visibility(lines[i].ray, lines[i].medium, ray_count);
    return;
  }
  Ray rays[TraceScene::kPacketSize];
  for (std::size_t i = 0; i < lines.size(); ++i) rays[i] = lines[i].ray;
  ray_count += lines.size();
  const std::uint32_t blocked = scene_.occludedPacket({rays, lines.size()});
  for (std::size_t i = 0; i < lines.size(); ++i)
    visible[i] = (blocked >> i) & 1U ? vec3(0.0F) : transmittanceOf(lines[i].medium, lines[i].ray.t_max);
}

vec3 Walker::visibility(const Ray& ray, const Material* medium, std::uint64_t& ray_count) const {
  vec3 visible = transmittanceOf(medium, ray.t_max);
  if (maxComponent(visible) == 0.0F) return vec3(0.0F);
  if (!materials_.anyPassable()) {
    ++ray_count;
    return scene_.occluded(ray) ? vec3(0.0F) : visible;
  }
  Ray rest = ray;
  SurfaceMaterial scratch;
  for (std::uint32_t step = 0; step < kMaxStraightSteps; ++step) {
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
