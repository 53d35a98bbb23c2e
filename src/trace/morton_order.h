// The order in which photons are best traced, and kept in memory: neighbours in space one after the other.
//
// Low-discrepancy points fall all over the light's domain, so in the order of their indices every photon finds other
// nodes of the hierarchy and other triangles, none of them in the cache, and a packet of eight has nothing in common.
// What looks for photons about a place finds them in as many lines of the cache as there are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math.h"

namespace nephroid {

class MortonOrder {
 public:
  /// @param bounds  of what is to be ordered; what lies beyond counts as on their border
  explicit MortonOrder(const Bounds& bounds);

  /// Place on a Morton curve through the sphere about the bounds.
  std::uint32_t keyOf(vec3 position) const { return keyOfOffset(position - centre_); }
  /// The same of a ray: of its point that is nearest to their centre. @param dir  unit
  std::uint32_t keyOf(vec3 origin, vec3 dir) const;
  /// Indices of `keys`, as keyOf makes them, by ascending key, equal ones in their order.
  static std::vector<std::uint32_t> sort(std::span<const std::uint32_t> keys);

 private:
  std::uint32_t keyOfOffset(vec3 from_centre) const;

  vec3 centre_;
  float steps_per_m_;
};

}  // namespace nephroid
