#include "techniques/reference/manifold/specular_chain.h"

#include <cmath>

#include "core/optics/refraction.shared.h"
#include "trace/bsdf.h"

namespace nephroid {
namespace {

/// Panes in a row before a chain is given up: two that face each other would hold it for ever.
constexpr int kMaxPanes = 64;

/// What a pane that was met lets through, holes being others' affair.
vec3 paneTransmittance(const Encounter& e, vec3 dir) {
  const SurfaceMaterial& m = *e.material;
  const Material* medium = e.boundary.from;
  const vec3 with_holes = passTransmittance(m, std::abs(dot(dir, e.point.normal_shading)), medium ? medium->ior : 1.0F);
  return (with_holes - (1.0F - m.coverage)) / m.coverage;
}

}  // namespace

ChainReceiver::ChainReceiver(const TraceScene& scene, const Encounter& encounter, const InteriorList& interior, vec3 wo)
    : encounter_(encounter), wo_(wo), interiors_{interior, interior} {
  for (const bool through : {false, true})
    usable_[through] = updateInterior(scene, encounter, through, interiors_[through]);
}

const InteriorList* ChainReceiver::interiorTowards(vec3 dir) const {
  const vec3 normal = encounter_.point.normal_geometric;
  const bool through = (dot(dir, normal) > 0.0F) != (dot(wo_, normal) > 0.0F);
  return usable_[through] ? &interiors_[through] : nullptr;
}

bool SpecularChain::start(vec3 dir) {
  count_ = 0;
  dir_ = dir;
  axes_ = Frame::fromZ(dir);
  const InteriorList* interior = receiver_.interiorTowards(dir);
  if (!interior) return false;
  state_.interior = *interior;
  state_.ray = Ray{offsetOrigin(receiver_.point(), dir), dir};
  differential_ = {vec3(0.0F), vec3(0.0F), axes_.x, axes_.y, true};
  return true;
}

bool SpecularChain::arrive(Vertex& vertex, Sampler& sampler, std::uint64_t& rays) {
  Encounter& e = vertex.encounter;
  vertex.transmittance = vec3(1.0F);
  for (int pane = 0; pane < kMaxPanes; ++pane) {
    world_.walker.advance(state_, sampler, e);
    rays += e.rays;
    if (!e.hit || e.overflow) return false;
    vertex.transmittance *= e.transmittance;
    if (!e.material->is_pane) return true;
    vertex.transmittance *= paneTransmittance(e, state_.ray.dir);
    if (maxComponent(vertex.transmittance) <= 0.0F) return false;
    state_.ray.origin = offsetOrigin(e.point, state_.ray.dir);
  }
  return false;
}

bool SpecularChain::advance(Sampler& sampler, std::uint64_t& rays) {
  if (count_ == kMaxManifoldEvents) return false;
  Vertex& v = vertices_[count_];
  if (!arrive(v, sampler, rays)) return false;
  const Encounter& e = v.encounter;
  v.dir = state_.ray.dir;
  if (!isWalkable(*e.material, e.boundary, world_.options.specular_alpha)) return false;
  if (!isSeenFromItsSide(e.point, -v.dir)) return false;
  v.normal = dot(e.point.normal_shading, v.dir) < 0.0F ? e.point.normal_shading : -e.point.normal_shading;
  v.ior_from = iorOf(e.boundary.from, 0.0F), v.ior_to = iorOf(e.boundary.to, 0.0F);
  const vec3 from = count_ == 0 ? receiver_.point().position : vertices_[count_ - 1].encounter.point.position;
  v.arrival = transferDifferential(differential_, v.dir, length(e.point.position - from), e.point.normal_geometric);
  ++count_;
  return v.arrival.valid;
}

bool SpecularChain::bend(Bounce bounce) {
  Vertex& v = vertices_[count_ - 1];
  const Encounter& e = v.encounter;
  vec3 out;
  if (bounce == Bounce::kReflect) {
    out = reflectDir(v.dir, v.normal);
  } else {
    const Refraction refraction = refractDir(v.dir, v.normal, v.ior_from / v.ior_to);
    if (!refraction.valid) return false;
    out = refraction.dir;
  }
  if (!joinsSides(bounce, out)) return false;
  v.bounce = bounce;
  differential_ = bendDifferential(v, bounce, v.arrival, v.dir, v.normal, v.ior_from / v.ior_to);
  if (!updateInterior(world_.scene, e, bounce == Bounce::kTransmit, state_.interior)) return false;
  state_.ray = Ray{offsetOrigin(e.point, out), out};
  return differential_.valid;
}

NormalDifferential SpecularChain::normalDifferential(const Vertex& vertex, vec3 normal,
                                                     const RayDifferential& r) const {
  const NormalGradient gradient = world_.scene.normalGradientAt(vertex.encounter.point);
  const float side = dot(normal, gradient.normal) < 0.0F ? -1.0F : 1.0F;
  return {side * gradient.along(r.dp_dx), side * gradient.along(r.dp_dy)};
}

RayDifferential SpecularChain::bendDifferential(const Vertex& vertex, Bounce bounce, const RayDifferential& r, vec3 dir,
                                                vec3 normal, float ior_ratio) const {
  const NormalDifferential dn = normalDifferential(vertex, normal, r);
  return bounce == Bounce::kReflect ? reflectDifferential(r, dir, normal, dn)
                                    : refractDifferential(r, dir, normal, dn, ior_ratio);
}

Bsdf SpecularChain::bsdfAt(int i) const {
  const Vertex& v = vertices_[i];
  return {*v.encounter.material, v.encounter.point, -v.dir, v.ior_from, v.ior_to, world_.options.specular_alpha};
}

const Material* SpecularChain::mediumAfter(int i, Bounce bounce) const {
  const Interface& boundary = vertices_[i].encounter.boundary;
  return bounce == Bounce::kReflect ? boundary.from : boundary.to;
}

vec3 SpecularChain::towardsLight(vec3 light, bool at_infinity) const {
  return at_infinity ? light : normalize(light - vertices_[count_ - 1].encounter.point.position);
}

ChainConstraint SpecularChain::constrain(Bounce last, vec3 light, bool at_infinity) const {
  const Vertex& v = vertices_[count_ - 1];
  const float ratio = last == Bounce::kReflect ? 1.0F : v.ior_to / v.ior_from;
  const vec3 out = towardsLight(light, at_infinity), n = v.normal;
  const NormalDifferential dn = normalDifferential(v, n, v.arrival);
  const Frame frame = Frame::fromZ(n);
  const auto inAxes = [&](vec3 d) { return vec2(dot(d, frame.x), dot(d, frame.y)); };
  const vec2 along = inAxes(out);
  const float sine = length(along);
  const bool wrong_side = (dot(out, n) > 0.0F) != (last == Bounce::kReflect) && sine > 0.0F;
  const auto change = [&](vec3 dp, vec3 dd, vec3 normal_change) {
    vec3 turn(0.0F);
    if (!at_infinity) turn = differentiateNormalized(light - v.encounter.point.position, -dp);
    vec2 out_change = inAxes(turn - normal_change * dot(out, n));
    if (wrong_side)
      out_change = (2.0F / sine - 1.0F) * out_change - along * (2.0F * dot(along, out_change) / (sine * sine * sine));
    return inAxes(dd - normal_change * dot(v.dir, n)) - ratio * out_change;
  };
  return {inAxes(v.dir) - ratio * (wrong_side ? (2.0F / sine - 1.0F) * along : along),
          change(v.arrival.dp_dx, v.arrival.dd_dx, dn.dn_dx), change(v.arrival.dp_dy, v.arrival.dd_dy, dn.dn_dy)};
}

bool SpecularChain::joinsSides(Bounce last, vec3 to_light) const {
  const Vertex& v = vertices_[count_ - 1];
  const vec3 normal = v.encounter.point.normal_geometric;
  const bool same_side = (dot(to_light, normal) > 0.0F) != (dot(v.dir, normal) > 0.0F);
  return same_side == (last == Bounce::kReflect) && isSeenFromItsSide(v.encounter.point, to_light);
}

vec3 SpecularChain::transmittance(Bounce last) const {
  vec3 kept(1.0F);
  for (int i = 0; i < count_; ++i) {
    const Bsdf bsdf = bsdfAt(i);
    const Bounce bounce = i == count_ - 1 ? last : vertices_[i].bounce;
    const vec3 reflected = bsdf.mirroring().reflectance;
    kept *= vertices_[i].transmittance * (bounce == Bounce::kReflect ? reflected : bsdf.interfaceAlbedo() - reflected);
  }
  return kept;
}

float SpecularChain::spread(Bounce last, vec3 light, bool at_infinity) const {
  vec3 dir = -towardsLight(light, at_infinity);
  vec3 from = light;
  const Frame frame = Frame::fromZ(dir);
  const vec3 none(0.0F);
  RayDifferential r = at_infinity ? RayDifferential{frame.x, frame.y, none, none, true}
                                  : RayDifferential{none, none, frame.x, frame.y, true};
  for (int i = count_ - 1; i >= 0; --i) {
    const Vertex& v = vertices_[i];
    const SurfacePoint& point = v.encounter.point;
    const Bounce bounce = i == count_ - 1 ? last : v.bounce;
    // From infinity the differential of the place is the same at any distance.
    const float distance = at_infinity && i == count_ - 1 ? 0.0F : length(point.position - from);
    r = transferDifferential(r, dir, distance, point.normal_geometric);
    const vec3 normal = bounce == Bounce::kReflect ? v.normal : -v.normal;
    r = bendDifferential(v, bounce, r, dir, normal, v.ior_to / v.ior_from);
    dir = -v.dir, from = point.position;
  }
  const SurfacePoint& end = receiver_.point();
  r = transferDifferential(r, dir, length(end.position - from), end.normal_geometric);
  return r.valid ? length(cross(r.dp_dx, r.dp_dy)) : 0.0F;
}

}  // namespace nephroid
