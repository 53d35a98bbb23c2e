// The share of light tracing that is tracing: rays per second against a plain loop over the same rays, on one thread;
// and what more threads give.
#include <fmt/format.h>

#include <algorithm>

#include "app/cli/bench.h"
#include "scene/edit.h"
#include "techniques/reference/light_tracing_bench.h"

namespace nephroid::cli {
namespace {

/// Enough rays that the clock is precise, few enough that they fit in memory and take a second.
constexpr std::uint32_t kPhotons = 200'000;

}  // namespace

std::vector<Measurement> measureLightTracingShare(const SceneData& scene, int repeats) {
  const Camera camera = selectCamera(scene, "0");
  const LightTracingMeasurement m = measureLightTracing(scene, camera, kPhotons, std::max(repeats, 1));
  if (m.ratio.empty()) return {};
  return {{"photon rays, 1 thread", "1/s", m.tracer_rays_per_s},
          {"plain rays, photon by photon", "1/s", m.plain_rays_per_s},
          {"plain rays, sorted", "1/s", m.plain_sorted_rays_per_s},
          {"photon rays / plain, by photon", "", m.ratio},
          {"photon rays / plain, sorted", "", m.ratio_sorted},
          {fmt::format("photon rays, {} threads / 1", m.threads), "", m.speedup}};
}

}  // namespace nephroid::cli
