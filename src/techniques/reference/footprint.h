// The footprint of a photon: where its neighbours in the emission domain would end, to first order.
//
// A light emits from a place and in a direction, four numbers in all. Every photon stands for a small cell of that
// domain; ray differentials [igehy-1999] carry the cell along the path. What it becomes on the receiver is the shape
// under which the photon's flux is best spread (photon differentials, [schjoth-2007]): narrow across a fold and long
// along it, and as wide as the light where that has a size ([frisvad-2014]). Spreading samples over cells of a domain
// that they fill evenly changes no expectation; the error is what a straight line misses of the light's way, second
// order in the size of the cell, and vanishes with it.
// Limits: roughness and wavelength are taken as the photon has them, so they blur nothing; so is a normal map.
#pragma once

#include <array>
#include <cmath>

#include "core/math.h"
#include "core/optics/ray_differential.shared.h"
#include "trace/emission.h"
#include "trace/trace_scene.h"

namespace nephroid {

/// What a photon's cell is on the plane of a receiver, world space, m.
struct FootprintAxes {
  vec3 place[2];      ///< by place on the light
  vec3 direction[2];  ///< by direction of emission
};

/// An ellipse on a plane as a symmetric matrix C: its rim is where dᵀ C⁻¹ d is 1.
struct FootprintShape {
  float xx = 0.0F, xy = 0.0F, yy = 0.0F;
  float place = 0.0F, direction = 0.0F;  ///< squared shares of the light's extent and of its directions in it

  void add(vec2 v, float scale) { xx += scale * v.x * v.x, xy += scale * v.x * v.y, yy += scale * v.y * v.y; }
  float trace() const { return xx + yy; }
  float determinant() const { return xx * yy - xy * xy; }
  /// Half-axes squared are half of the trace, more and less by this.
  float spread() const {
    const float half = 0.5F * (xx - yy);
    return std::sqrt(half * half + xy * xy);
  }
};

/// Carried along a path from its light. Every event on the way has its function here.
class Footprint {
 public:
  /// @param extent  of the whole emission domain about the photon
  Footprint(const EmissionExtent& extent, vec3 dir);

  /// After a straight flight of length `distance` along `dir` to `point`.
  void transfer(vec3 dir, float distance, const SurfacePoint& point);
  /// After the interface at `point` sent `dir` on to `dir_out`. Takes the normal that this direction belongs to, so it
  /// holds for microfacets as well.
  /// @param ior_ratio  of the side of `dir` to the other; not used for a reflection
  void bend(const TraceScene& scene, const SurfacePoint& point, vec3 dir, vec3 dir_out, bool transmitted,
            float ior_ratio);
  /// One of several ways on was chosen: photons on this one are as much farther apart. @param probability  in (0, 1]
  void choose(float probability) { probability_ *= probability; }
  /// Scattered every way: there is no footprint any more.
  void lose() { place_.valid = direction_.valid = false; }

  bool valid() const { return place_.valid && direction_.valid; }
  /// Of all choices on the way.
  float probability() const { return probability_; }
  bool hasPlace() const { return has_place_; }
  bool hasDirection() const { return has_direction_; }
  /// Half-axes of the whole domain as it arrives, were the way straight: those of a cell are as much shorter as it is.
  FootprintAxes axes() const { return {{place_.dp_dx, place_.dp_dy}, {direction_.dp_dx, direction_.dp_dy}}; }
  /// Of a cell of the domain, on a plane. @param cell  its share of the domain, were there no choices on the way
  /// @param project  a vector of world space onto that plane
  template <class Project>
  FootprintShape shapeOf(float cell, Project&& project) const {
    FootprintShape place, direction;
    const FootprintAxes axes = this->axes();
    for (int k = 0; k < 2; ++k)
      place.add(project(axes.place[k]), 1.0F), direction.add(project(axes.direction[k]), 1.0F);
    return mix(place, direction, cell);
  }

  /// The same on a surface: half-axes of the ellipse, m, perpendicular to each other and to the normal. Zeros if it has
  /// none. @param normal  unit
  std::array<vec3, 2> halfAxesOn(vec3 normal, float cell) const;

 private:
  FootprintShape mix(const FootprintShape& place, const FootprintShape& direction, float cell) const;

  RayDifferential place_, direction_;
  float probability_ = 1.0F;
  bool has_place_, has_direction_;
};

}  // namespace nephroid
