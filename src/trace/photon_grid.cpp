#include "trace/photon_grid.h"

#include <algorithm>
#include <bit>

namespace nephroid {

PhotonGrid::PhotonGrid(std::span<const GridPhoton> photons, float radius)
    : radius_(radius), inverse_cell_(0.5F / radius) {
  if (photons.empty()) return;
  const std::uint32_t buckets = std::bit_ceil(static_cast<std::uint32_t>(photons.size()));
  mask_ = buckets - 1;
  begin_.assign(buckets + 1, 0);
  const auto bucketOf = [&](const GridPhoton& p) {
    const vec3 cell = p.position * inverse_cell_;
    return hashCell(cellOf(cell.x), cellOf(cell.y), cellOf(cell.z));
  };
  for (const GridPhoton& p : photons) ++begin_[bucketOf(p) + 1];
  for (std::uint32_t b = 0; b < buckets; ++b) begin_[b + 1] += begin_[b];
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  photons_.resize(photons.size());
  for (const GridPhoton& p : photons) photons_[next[bucketOf(p)]++] = p;
}

float chooseGatherRadius(std::span<const GridPhoton> photons, float expected) {
  Bounds bounds;
  for (const GridPhoton& p : photons) bounds.add(p.position);
  if (bounds.empty()) return 0.0F;
  const vec3 e = bounds.extent();
  const float area = std::max({e.x * e.y, e.y * e.z, e.z * e.x});
  return std::sqrt(expected * area / (kPi * static_cast<float>(photons.size())));
}

}  // namespace nephroid
