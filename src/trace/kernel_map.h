// Photons, each spread over an ellipse of the surface on which it ended, found by place.
//
// The ellipse is the photon's footprint where it has one (photon differentials, [schjoth-2007]), which neighbours fill
// evenly: those of a caustic overlap with little noise, however its sheets lie over each other. Else it is a disc.
// Ellipses whose areas are within a factor of four share a grid of the boxes around them (box_grid.h), so that a place
// looks into one cell of each grid. Kept along a Morton curve, those of one place on it in their own order, so that
// sums over a place do not depend on threads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "trace/box_grid.h"
#include "trace/kernel_radii.h"
#include "trace/photon_grid.h"

namespace nephroid {

/// A photon under Epanechnikov's kernel, 2 (1 − r²) over the area of its ellipse. All of it is in one cache line.
struct alignas(64) KernelPhoton {
  vec3 position;       ///< world, m
  vec3 across[2];      ///< r is how long an offset is in these, 1/m; perpendicular to each other and to the normal
  float inverse_axes;  ///< one over the product of both half-axes, 1/m²
  vec3 dir;            ///< unit, along the travel of light
  vec3 flux;           ///< W, as in GridPhoton

  /// Of the surface there, over `inverse_axes` unit.
  vec3 scaledNormal() const { return cross(across[0], across[1]); }
  /// An offset that is under it is no higher, m².
  float squaredThickness() const { return kKernelFlatness * kKernelFlatness / inverse_axes; }
  /// Is either off the other's plane by no more than a share of the ellipse's radius?
  bool isThinAt(vec3 offset, vec3 normal_there) const {
    const float height = dot(offset, normal_there), own = dot(offset, scaledNormal());
    constexpr float kMost = kKernelFlatness * kKernelFlatness;
    return height * height * inverse_axes <= kMost && own * own <= kMost * inverse_axes;
  }
  /// r², in half-axes. @param offset  from it, m
  float squaredRadiusOf(vec3 offset) const {
    const float a = dot(offset, across[0]), b = dot(offset, across[1]);
    return a * a + b * b;
  }
  /// 1/m². @param squared_radius  r², below 1
  float weightAt(float squared_radius) const { return 2.0F / kPi * inverse_axes * (1.0F - squared_radius); }
  /// The same of an ellipse of half the area.
  float halfWeightAt(float squared_radius) const {
    return 4.0F / kPi * inverse_axes * std::max(1.0F - 2.0F * squared_radius, 0.0F);
  }
};
static_assert(sizeof(KernelPhoton) == 64);

class KernelMap {
 public:
  KernelMap() = default;
  /// @param radii  of discs, and what keeps footprints within bounds; not made by default, where there are photons
  /// @param scale  of all radii and half-axes
  KernelMap(std::span<const GridPhoton> photons, const KernelRadii& radii, float scale);

  bool empty() const { return photons_.empty(); }

  /// Calls `visit(photon, r²)` for every photon whose ellipse holds `position`, if that is on a plane of this normal:
  /// an ellipse is thin, so that it does not reach around corners.
  /// @param normal  unit
  template <class Visit>
  void visitKernels(vec3 position, vec3 normal, Visit&& visit) const {
    for (const BoxGrid& grid : grids_)
      grid.visitBoxesAt(position, [&](std::uint32_t index) {
        const KernelPhoton& photon = photons_[index];
        const vec3 offset = position - photon.position;
        const float squared = photon.squaredRadiusOf(offset);
        if (squared < 1.0F && photon.isThinAt(offset, normal)) visit(photon, squared);
      });
  }

 private:
  class GridBuilder;

  std::vector<KernelPhoton> photons_;
  std::vector<BoxGrid> grids_;
};

}  // namespace nephroid
