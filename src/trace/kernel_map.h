// Photons, each spread over an ellipse of the surface on which it ended, found by place.
//
// The ellipse is the photon's footprint where it has one (photon differentials, [schjoth-2007]), which neighbours fill
// evenly: those of a caustic overlap with little noise, however its sheets lie over each other. Else it is a disc.
// Each is entered in every cell of a grid that it meets, so that a place looks into one cell. Ellipses whose areas are
// within a factor of four share a grid, whose cells are as wide as the radius of a disc like the largest. Built in the
// order of the photons, so that sums over a place do not depend on threads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "trace/kernel_radii.h"
#include "trace/photon_grid.h"

namespace nephroid {

/// A photon under Epanechnikov's kernel, 2 (1 − r²) over the area of its ellipse. What tells whether a place is under
/// it is in one cache line.
struct alignas(64) KernelPhoton {
  vec3 position;            ///< world, m
  vec3 across[2];           ///< r is how long an offset is in these, 1/m
  vec3 normal;              ///< of the surface there, unit
  float thickness_squared;  ///< an offset that is under it is no higher, m²
  float inverse_axes;       ///< one over the product of both half-axes, 1/m²
  vec3 dir;                 ///< unit, along the travel of light
  vec3 flux;                ///< W, as in GridPhoton

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
    for (const Grid& grid : grids_) {
      const std::uint32_t bucket = grid.bucketOf(grid.cellAt(position));
      for (std::uint32_t i = grid.begin[bucket]; i < grid.begin[bucket + 1]; ++i) {
        const KernelPhoton& photon = photons_[grid.entries[i]];
        const vec3 offset = position - photon.position;
        const float squared = photon.squaredRadiusOf(offset);
        if (squared < 1.0F && isThin(photon, offset, normal)) visit(photon, squared);
      }
    }
  }

 private:
  /// Cells of one width, by a hash of where they are.
  struct Grid {
    float inverse_cell = 0.0F;  ///< 1/m
    std::uint32_t mask = 0;
    std::vector<std::uint32_t> begin;    ///< bucket count + 1 offsets
    std::vector<std::uint32_t> entries;  ///< into photons_, by bucket

    glm::ivec3 cellAt(vec3 position) const;
    vec3 middleOf(glm::ivec3 cell) const;
    std::uint32_t bucketOf(glm::ivec3 cell) const { return hashOfCell(cell.x, cell.y, cell.z) & mask; }
  };
  class GridBuilder;

  /// Is either off the other's plane by no more than a share of the ellipse's radius?
  static bool isThin(const KernelPhoton& photon, vec3 offset, vec3 normal) {
    const float height = dot(offset, normal), own = dot(offset, photon.normal);
    return std::max(height * height, own * own) <= photon.thickness_squared;
  }

  std::vector<KernelPhoton> photons_;
  std::vector<Grid> grids_;
};

/// Where the origin lies in its cell: not on its border, for many scenes have a floor there, which would then lie in
/// two layers of cells.
inline constexpr float kOriginInCell = 0.37F;

inline glm::ivec3 KernelMap::Grid::cellAt(vec3 position) const {
  constexpr float kMost = 1e9F;  // far beyond where floats still tell cells apart
  return glm::floor(glm::clamp(position * inverse_cell + kOriginInCell, -kMost, kMost));
}
inline vec3 KernelMap::Grid::middleOf(glm::ivec3 cell) const {
  return (vec3(cell) + (0.5F - kOriginInCell)) / inverse_cell;
}

}  // namespace nephroid
