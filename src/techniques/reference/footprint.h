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

 private:
  RayDifferential place_, direction_;
  float probability_ = 1.0F;
  bool has_place_, has_direction_;
};

}  // namespace nephroid
