// Radii of photons' kernels by how densely photons lie about them.
//
// A kernel blurs in proportion to its area, and its noise falls with the photons under it: so it should be narrow where
// photons are dense and wide where they are sparse. With radii in proportion to the root of the inverse density all
// kernels hold as many photons, and where the density varies smoothly their blur cancels to first order (Abramson 1982,
// "On bandwidth variation in kernel estimates: a square root law"). The density is that of one batch of photons, as
// cells of an octree have it, and stays: what comes later is independent of it, so each photon keeps its flux in the
// mean, wherever its kernel spreads it.
// Limits: the density of a cell is some 30 % off, and with it kernels' areas. Seen from one place to the next that errs
// by a few per cent as long as kernels are as wide as cells; it goes as they shrink.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trace/photon_grid.h"

namespace nephroid {

class KernelRadii {
 public:
  KernelRadii() = default;
  /// @param photons   whose density is meant, one at least  @param expected  of them under a kernel
  /// @param range     of radii, m
  KernelRadii(std::span<const GridPhoton> photons, float expected, float narrowest, float widest);

  float widest() const { return widest_; }
  /// m. Constant over cells that hold some dozen photons. @pre not made by default
  float at(vec3 position) const;

 private:
  /// A cube of an octree.
  struct Node {
    std::uint32_t children = 0;  ///< the first of eight; 0: none
    float radius = 0.0F;         ///< m
  };
  void split(std::uint32_t node, std::span<vec3> positions, vec3 centre, float half_side, int depth, float expected,
             float radius_around);
  float radiusOf(std::span<const vec3> positions, float expected) const;

  std::vector<Node> nodes_;
  vec3 centre_{0.0F};
  float half_side_ = 0.0F, narrowest_ = 0.0F, widest_ = 0.0F;
};

}  // namespace nephroid
