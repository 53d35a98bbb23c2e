// Photons, each under a kernel of its own radius, found by place: grids of radii a factor of two apart.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trace/kernel_radii.h"
#include "trace/photon_grid.h"

namespace nephroid {

/// A photon spread evenly over a disc.
struct KernelPhoton : GridPhoton {
  float radius_squared;  ///< of the disc, m²
  float inverse_area;    ///< of the disc, 1/m²
};

class KernelMap {
 public:
  KernelMap() = default;
  /// @param radii  not made by default, where there are photons  @param scale  of all radii
  KernelMap(std::span<const GridPhoton> photons, const KernelRadii& radii, float scale);

  bool empty() const { return grids_.empty(); }

  /// Calls `visit(photon, distance²)` for every photon whose disc holds `position`, if that is on a plane of this
  /// normal: a disc is thin, so that it does not reach around corners.
  template <class Visit>
  void visitKernels(vec3 position, vec3 normal, Visit&& visit) const {
    for (const BasicPhotonGrid<KernelPhoton>& grid : grids_) {
      grid.visitDisc(position, normal, kKernelFlatness, [&](const KernelPhoton& photon) {
        const vec3 offset = photon.position - position;
        const float squared = dot(offset, offset), height = dot(offset, normal);
        if (squared <= photon.radius_squared &&
            height * height <= kKernelFlatness * kKernelFlatness * photon.radius_squared)
          visit(photon, squared);
      });
    }
  }

 private:
  std::vector<BasicPhotonGrid<KernelPhoton>> grids_;
};

}  // namespace nephroid
