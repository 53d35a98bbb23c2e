#include "techniques/reference/footprint.h"

#include <cmath>

namespace nephroid {
namespace {

/// Half-axis of the disc that has the area of a square of side 1.
const float kDiscOfSquare = 1.0F / std::sqrt(kPi);

}  // namespace

Footprint::Footprint(const EmissionExtent& extent, vec3 dir)
    : has_place_(extent.place > 0.0F), has_direction_(extent.direction > 0.0F) {
  const Frame frame = Frame::fromZ(dir);
  const float place = extent.place * kDiscOfSquare, direction = extent.direction * kDiscOfSquare;
  place_ = {place * frame.x, place * frame.y, vec3(0.0F), vec3(0.0F), true};
  direction_ = {vec3(0.0F), vec3(0.0F), direction * frame.x, direction * frame.y, true};
}

void Footprint::transfer(vec3 dir, float distance, const SurfacePoint& point) {
  if (!valid()) return;
  place_ = transferDifferential(place_, dir, distance, point.normal_geometric);
  direction_ = transferDifferential(direction_, dir, distance, point.normal_geometric);
}

void Footprint::bend(const TraceScene& scene, const SurfacePoint& point, vec3 dir, vec3 dir_out, bool transmitted,
                     float ior_ratio) {
  if (!valid()) return;
  if (transmitted && ior_ratio == 1.0F) return;
  const vec3 across = transmitted ? ior_ratio * dir - dir_out : dir_out - dir;
  const float squared = dot(across, across);
  if (squared <= 0.0F) return;
  vec3 normal = across / std::sqrt(squared);
  if (dot(normal, dir) > 0.0F) normal = -normal;
  const NormalGradient gradient = scene.normalGradientAt(point);
  const float side = dot(normal, gradient.normal) < 0.0F ? -1.0F : 1.0F;
  for (RayDifferential* r : {&place_, &direction_}) {
    const NormalDifferential dn{side * gradient.along(r->dp_dx), side * gradient.along(r->dp_dy)};
    *r = transmitted ? refractDifferential(*r, dir, normal, dn, ior_ratio) : reflectDifferential(*r, dir, normal, dn);
  }
}

}  // namespace nephroid
