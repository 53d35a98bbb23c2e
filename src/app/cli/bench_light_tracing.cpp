// The share of light tracing that is tracing: rays per second against a plain loop over the same rays, on one thread.
#include <algorithm>

#include "app/cli/bench.h"
#include "scene/edit.h"
#include "techniques/reference/light_tracing_bench.h"

namespace nephroid::cli {
namespace {

/// Enough rays that the clock is precise, few enough that they fit in memory and take a second.
constexpr std::uint32_t kPhotons = 100'000;

}  // namespace

std::vector<Measurement> measureLightTracingShare(const SceneData& scene, int repeats) {
  const Camera camera = selectCamera(scene, "0");
  const LightTracingMeasurement m = measureLightTracing(scene, camera, kPhotons, std::max(repeats, 1));
  if (m.ratio.empty()) return {};
  return {{"photon rays, 1 thread", "1/s", m.tracer_rays_per_s},
          {"plain rays, 1 thread", "1/s", m.plain_rays_per_s},
          {"photon rays / plain rays", "", m.ratio}};
}

}  // namespace nephroid::cli
