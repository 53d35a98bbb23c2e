// How much of the time of light tracing is the tracing: its rays per second against those of a plain loop of
// rtcIntersect1 over the very same rays.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene_data.h"

namespace nephroid {

struct LightTracingMeasurement {
  std::size_t triangle_count = 0;
  std::uint64_t photons = 0, rays = 0;    ///< of one repetition
  std::vector<double> tracer_rays_per_s;  ///< one thread, everything that a photon needs, splats included
  std::vector<double> plain_rays_per_s;   ///< one thread, rtcIntersect1 and nothing else
  std::vector<double> ratio;              ///< of the two, repetition by repetition
};

/// @param photons      per repetition; their rays are held in memory, 28 bytes each
/// @param repetitions  after one of each that is not counted
/// @return             without measurements if no light reaches anything that bends it
LightTracingMeasurement measureLightTracing(const SceneData& scene, const Camera& camera, std::uint32_t photons,
                                            int repetitions);

}  // namespace nephroid
