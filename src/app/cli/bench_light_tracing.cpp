// The share of light tracing that is tracing: rays per second against a plain loop over the same rays, on one thread;
// and what more threads give.
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "app/cli/bench_speed.h"
#include "scene/edit.h"
#include "techniques/reference/light_tracing_bench.h"

namespace nephroid::cli {
namespace {

/// Enough rays that the clock is precise, few enough that they fit in memory and take a second.
constexpr std::uint32_t kPhotons = 200'000;

/// Of the fastest repetitions of both: what else runs on the machine only slows, and slows arithmetic more than waiting
/// for memory.
std::vector<double> fastestOver(std::span<const double> tracer, std::span<const double> plain) {
  return {*std::max_element(tracer.begin(), tracer.end()) / *std::max_element(plain.begin(), plain.end())};
}

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
          {"fastest / fastest plain, by photon", "", fastestOver(m.tracer_rays_per_s, m.plain_rays_per_s)},
          {"fastest / fastest plain, sorted", "", fastestOver(m.tracer_rays_per_s, m.plain_sorted_rays_per_s)},
          {fmt::format("photon rays, {} threads / 1", m.threads), "", m.speedup}};
}

}  // namespace nephroid::cli
