// Photons where they ended, found again by place: a hash grid over one batch (Jensen 2001; cells as in Teschner 2003).
//
// Cells are as wide as the diameter of a search, so a search looks at eight, less those that it does not reach. Built
// in the order of the photons, so that sums over a search do not depend on threads.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math.h"
#include "trace/cell_hash.h"

namespace nephroid {

/// Height of a kernel's disc over its radius: thin enough not to look around corners, thick enough for curved ground.
inline constexpr float kKernelFlatness = 0.3F;

/// What a receiver needs of a photon that ended on it.
struct GridPhoton {
  vec3 position;      ///< world, m
  vec3 dir;           ///< unit, along the travel of light
  vec3 flux;          ///< W, as it counts on the shaded surface (see Bsdf::shadingCosineRatio)
  vec3 normal{0.0F};  ///< of the surface there, unit; where it is asked for
  /// Half-axes of its footprint on the plane there, perpendicular to each other, m; 0 where it has none.
  std::array<vec3, 2> axes{vec3(0.0F), vec3(0.0F)};
};

/// @tparam Photon  has a `position`
template <class Photon>
class BasicPhotonGrid {
 public:
  BasicPhotonGrid() = default;
  /// @param radius  of every search, m, > 0
  BasicPhotonGrid(std::span<const Photon> photons, float radius) : radius_(radius), inverse_cell_(0.5F / radius) {
    if (photons.empty()) return;
    const std::uint32_t buckets = std::bit_ceil(static_cast<std::uint32_t>(photons.size()));
    mask_ = buckets - 1;
    begin_.assign(buckets + 1, 0);
    const auto bucketOf = [&](const Photon& p) {
      const vec3 cell = p.position * inverse_cell_;
      return hashCell(cellOf(cell.x), cellOf(cell.y), cellOf(cell.z));
    };
    for (const Photon& p : photons) ++begin_[bucketOf(p) + 1];
    for (std::uint32_t b = 0; b < buckets; ++b) begin_[b + 1] += begin_[b];
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    photons_.resize(photons.size());
    for (const Photon& p : photons) photons_[next[bucketOf(p)]++] = p;
  }

  bool empty() const { return photons_.empty(); }
  float radius() const { return radius_; }

  /// Calls `visit(photon)` for every photon within the radius of `position`.
  template <class Visit>
  void visitNear(vec3 position, Visit&& visit) const {
    if (empty()) return;
    const vec3 place = position * inverse_cell_, first = glm::floor(place - 0.5F);
    const int x0 = static_cast<int>(first.x), y0 = static_cast<int>(first.y), z0 = static_cast<int>(first.z);
    const float squared_radius = radius_ * radius_;
    std::uint32_t seen[8];
    int count = 0;
    for (int k = 0; k < 8; ++k) {
      const int dx = k & 1, dy = (k >> 1) & 1, dz = k >> 2;
      const vec3 to_middle = first + vec3(dx, dy, dz) + 0.5F - place;
      const vec3 outside = glm::max(glm::abs(to_middle) - 0.5F, vec3(0.0F));
      // A little more than the radius, for rounding: photons are asked one by one.
      if (dot(outside, outside) > 0.2501F) continue;
      const std::uint32_t bucket = hashCell(x0 + dx, y0 + dy, z0 + dz);
      // Two cells may share a bucket; its photons count once.
      bool repeated = false;
      for (int i = 0; i < count; ++i) repeated = repeated || seen[i] == bucket;
      if (repeated) continue;
      seen[count++] = bucket;
      for (std::uint32_t i = begin_[bucket]; i < begin_[bucket + 1]; ++i) {
        const vec3 offset = photons_[i].position - position;
        if (dot(offset, offset) <= squared_radius) visit(photons_[i]);
      }
    }
  }

 private:
  static int cellOf(float x) { return static_cast<int>(std::floor(x)); }
  std::uint32_t hashCell(int x, int y, int z) const { return hashOfCell(x, y, z) & mask_; }

  std::vector<Photon> photons_;       ///< bucket by bucket
  std::vector<std::uint32_t> begin_;  ///< bucket count + 1 offsets
  float radius_ = 0.0F, inverse_cell_ = 0.0F;
  std::uint32_t mask_ = 0;
};

using PhotonGrid = BasicPhotonGrid<GridPhoton>;

/// A first radius that finds about `expected` photons where they are spread evenly over the largest side of their box.
float chooseGatherRadius(std::span<const GridPhoton> photons, float expected);

}  // namespace nephroid
