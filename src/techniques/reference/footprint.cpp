#include "techniques/reference/footprint.h"

#include <algorithm>
#include <cmath>

namespace nephroid {
namespace {

/// Half-axis of the disc that has the area of a square of side 1.
const float kDiscOfSquare = 1.0F / std::sqrt(kPi);
/// Widest share of a light's extent over which one photon is spread: more, and the light would look larger.
constexpr float kMostShare = 0.5F;

struct Shares {
  float place, direction;  ///< squared
};

/// Squared shares of the light's extent and of its directions whose product is the cell: those that together make the
/// smallest kernel, that is, equal shares in it (of all a, b with a·b = c², p·a + d·b is least where both are equal).
Shares chooseShares(float cell, float place_trace, float direction_trace) {
  constexpr float kMost = kMostShare * kMostShare;
  if (!(place_trace > 0.0F)) return {0.0F, std::min(cell, kMost)};
  if (!(direction_trace > 0.0F)) return {std::min(cell, kMost), 0.0F};
  const float place = std::sqrt(cell * direction_trace / place_trace);
  if (place > kMost) return {kMost, std::min(cell / kMost, kMost)};
  const float direction = cell / place;
  if (direction > kMost) return {std::min(cell / kMost, kMost), kMost};
  return {place, direction};
}

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

std::array<vec3, 2> Footprint::halfAxesOn(vec3 normal, float cell) const {
  const Frame frame = Frame::fromZ(normal);
  const FootprintShape c = shapeOf(cell, [&](vec3 axis) { return vec2(dot(axis, frame.x), dot(axis, frame.y)); });
  const float middle = 0.5F * c.trace(), spread = c.spread();
  if (!std::isfinite(middle)) return {vec3(0.0F), vec3(0.0F)};
  const float turn = 0.5F * std::atan2(c.xy, 0.5F * (c.xx - c.yy));
  const vec3 along = std::cos(turn) * frame.x + std::sin(turn) * frame.y;
  return {std::sqrt(middle + spread) * along, std::sqrt(std::max(middle - spread, 0.0F)) * cross(normal, along)};
}

FootprintShape Footprint::mix(const FootprintShape& place, const FootprintShape& direction, float cell) const {
  const float share = std::min(cell / probability_, 1.0F);
  const Shares shares = has_place_ && has_direction_ ? chooseShares(share, place.trace(), direction.trace())
                                                     : Shares{std::min(share, 0.25F), std::min(share, 0.25F)};
  return {shares.place * place.xx + shares.direction * direction.xx,
          shares.place * place.xy + shares.direction * direction.xy,
          shares.place * place.yy + shares.direction * direction.yy, shares.place, shares.direction};
}

}  // namespace nephroid
