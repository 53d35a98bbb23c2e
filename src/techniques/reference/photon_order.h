// The order in which photons are best traced: neighbours in space one after the other.
//
// Low-discrepancy points fall all over the light's domain, so in the order of their indices every photon finds other
// nodes of the hierarchy and other triangles, none of them in the cache, and a packet of eight has nothing in common.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math.h"

namespace nephroid {

class PhotonOrder {
 public:
  /// @param targets  what the photons are aimed at
  explicit PhotonOrder(const Bounds& targets);

  /// Place of a ray on a Morton curve through the targets: of its point that is nearest to their centre.
  std::uint32_t keyOf(vec3 origin, vec3 dir) const;
  /// Indices of `keys`, as keyOf makes them, by ascending key, equal ones in their order.
  static std::vector<std::uint32_t> sort(std::span<const std::uint32_t> keys);

 private:
  vec3 centre_;
  float steps_per_m_;
};

}  // namespace nephroid
