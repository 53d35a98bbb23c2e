#include "trace/photon_grid.h"

#include <algorithm>

namespace nephroid {

float chooseGatherRadius(std::span<const GridPhoton> photons, float expected) {
  Bounds bounds;
  for (const GridPhoton& p : photons) bounds.add(p.position);
  if (bounds.empty()) return 0.0F;
  const vec3 e = bounds.extent();
  const float area = std::max({e.x * e.y, e.y * e.z, e.z * e.x});
  return std::sqrt(expected * area / (kPi * static_cast<float>(photons.size())));
}

}  // namespace nephroid
