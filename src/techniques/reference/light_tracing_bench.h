// How much of the time of light tracing is the tracing: its rays per second against those of a plain loop of
// rtcIntersect1 over the very same rays.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene_data.h"

namespace nephroid {

struct LightTracingMeasurement {
  std::size_t triangle_count = 0;
  int threads = 1;
  std::uint64_t photons = 0, rays = 0;  ///< of one repetition
  // One value a repetition. On one thread unless said.
  std::vector<double> tracer_rays_per_s;        ///< everything that a photon needs, splats included
  std::vector<double> tracer_rays_per_s_all;    ///< on all threads
  std::vector<double> plain_rays_per_s;         ///< rtcIntersect1 and nothing else, photon after photon
  std::vector<double> plain_sorted_rays_per_s;  ///< the same in the order in which the light tracer sorts them
  std::vector<double> ratio;                    ///< of tracer_rays_per_s to plain_rays_per_s
  std::vector<double> ratio_sorted;             ///< of tracer_rays_per_s to plain_sorted_rays_per_s
  std::vector<double> speedup;                  ///< of all threads over one
};

/// @param photons      per repetition, at most PhotonBatch::kMaxPhotons; their rays are held in memory twice, 28 bytes
///                     each
/// @param repetitions  after one of each that is not counted
/// @return             without measurements if no light reaches anything that bends it
LightTracingMeasurement measureLightTracing(const SceneData& scene, const Camera& camera, std::uint32_t photons,
                                            int repetitions);

}  // namespace nephroid
