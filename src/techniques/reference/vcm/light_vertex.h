// What photons of vertex connection and merging leave behind for paths from the eye.
#pragma once

#include <cstdint>

#include "techniques/reference/vcm/weights.h"
#include "trace/bsdf.h"

namespace nephroid {

/// A caustic photon where it ended.
struct VcmPhoton {
  vec3 position;         ///< world, m
  vec3 dir;              ///< unit, along the travel of light
  vec3 flux;             ///< W, as it counts on the shaded surface; in a tally × emitted count
  VcmPartial half;       ///< on arrival
  std::uint32_t events;  ///< before it ended here
};

/// A vertex of a photon's path that can be connected: a rough interface, or where the photon ended.
struct VcmLightVertex {
  SurfacePoint point;
  vec3 wo;    ///< unit, to where the photon came from
  vec3 flux;  ///< incident, W; in a tally × emitted count
  const Material* outer;
  const Material* inner;
  VcmPartial half;         ///< on arrival
  std::uint32_t events;    ///< this one too
  EventClass event_class;  ///< of the event by which it would be connected
};

}  // namespace nephroid
