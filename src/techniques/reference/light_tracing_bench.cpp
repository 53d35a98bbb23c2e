#include "techniques/reference/light_tracing_bench.h"

#include <chrono>

#include "core/parallel.h"
#include "techniques/reference/photon_batch.h"

namespace nephroid {
namespace {

template <class Work>
double secondsOf(Work&& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// The plain loop. @return hits, so that nothing is optimised away
std::uint64_t tracePlain(const TraceScene& scene, const std::vector<Ray>& rays) {
  std::uint64_t hits = 0;
  for (const Ray& ray : rays) {
    RTCRayHit query{};
    query.ray.org_x = ray.origin.x, query.ray.org_y = ray.origin.y, query.ray.org_z = ray.origin.z;
    query.ray.dir_x = ray.dir.x, query.ray.dir_y = ray.dir.y, query.ray.dir_z = ray.dir.z;
    query.ray.tfar = ray.t_max;
    query.ray.mask = ~0U;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersectClosest(scene.embreeScene(), query);
    hits += query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }
  return hits;
}

/// The rays of a batch in the order in which the light tracer traces them, or (not `sorted`) photon after photon in the
/// order of their indices, as a tracer without packets makes them.
std::vector<Ray> recordRays(ReferenceWorld& world, const LightTracer& tracer, std::span<const std::uint32_t> shares,
                            bool sorted) {
  std::vector<Ray> rays;
  for (std::size_t e = 0; e < shares.size(); ++e) {
    PhotonWave wave;
    PhotonTally tally;
    wave.reset(0, shares[e]);
    tracer.emit(e, 0, shares[e], wave, tally);
    wave.close(sorted);
    const std::uint32_t step = sorted ? wave.size() : 1;
    world.scene.setRecorder(&rays);
    for (std::uint32_t i = 0; i < wave.size(); i += step) tracer.trace(e, wave, i, i + step, FootprintScale{}, tally);
    world.scene.setRecorder(nullptr);
  }
  return rays;
}

}  // namespace

LightTracingMeasurement measureLightTracing(const SceneData& scene, const Camera& camera, std::uint32_t photons,
                                            int repetitions) {
  constexpr int kWidth = 1024, kHeight = 768;
  ReferenceWorld world(scene, camera, kWidth, kHeight, ReferenceOptions{});
  const LightTracer tracer(world, PhotonPaths{.caustic = true});
  LightTracingMeasurement m;
  m.triangle_count = scene.triangleCount();
  m.threads = availableThreads();
  if (tracer.emitters().empty()) return m;
  const std::vector<std::uint32_t> shares = tracer.sharePhotons(photons);
  for (const std::uint32_t share : shares) m.photons += share;
  const std::vector<Ray> by_photon = recordRays(world, tracer, shares, false);
  const std::vector<Ray> sorted = recordRays(world, tracer, shares, true);
  m.rays = sorted.size();
  PhotonBatch batch(tracer, photons, kWidth, kHeight);
  const auto trace = [&] { batch.trace(0, [] { return false; }); };
  const auto rate = [&](auto&& work) { return static_cast<double>(m.rays) / secondsOf(work); };
  volatile std::uint64_t keep = 0;
  runWithThreads(1, trace);
  for (int i = 0; i < repetitions; ++i) {
    m.tracer_rays_per_s.push_back(rate([&] { runWithThreads(1, trace); }));
    m.plain_rays_per_s.push_back(rate([&] { keep = tracePlain(world.scene, by_photon); }));
    m.plain_sorted_rays_per_s.push_back(rate([&] { keep = tracePlain(world.scene, sorted); }));
    m.tracer_rays_per_s_all.push_back(rate([&] { runWithThreads(m.threads, trace); }));
    m.ratio.push_back(m.tracer_rays_per_s.back() / m.plain_rays_per_s.back());
    m.ratio_sorted.push_back(m.tracer_rays_per_s.back() / m.plain_sorted_rays_per_s.back());
    m.speedup.push_back(m.tracer_rays_per_s_all.back() / m.tracer_rays_per_s.back());
  }
  static_cast<void>(keep);
  return m;
}

}  // namespace nephroid
