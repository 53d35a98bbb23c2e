#include "techniques/reference/light_tracing_bench.h"

#include <chrono>

#include "techniques/reference/light_tracer.h"

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

}  // namespace

LightTracingMeasurement measureLightTracing(const SceneData& scene, const Camera& camera, std::uint32_t photons,
                                            int repetitions) {
  ReferenceWorld world(scene, camera, 1024, 768, ReferenceOptions{});
  const LightTracer tracer(world, false);
  LightTracingMeasurement m;
  m.triangle_count = scene.triangleCount();
  if (tracer.emitters().empty()) return m;
  const std::vector<std::uint32_t> shares = tracer.sharePhotons(photons);
  const auto trace = [&] {
    PhotonTally tally;
    for (std::size_t e = 0; e < shares.size(); ++e) tracer.trace(e, 0, shares[e], tally);
    return tally.rays;
  };
  for (const std::uint32_t share : shares) m.photons += share;
  std::vector<Ray> rays;
  world.scene.setRecorder(&rays);
  m.rays = trace();
  world.scene.setRecorder(nullptr);
  volatile std::uint64_t keep = tracePlain(world.scene, rays);
  for (int i = 0; i < repetitions; ++i) {
    const double traced = secondsOf([&] { keep = trace(); });
    const double plain = secondsOf([&] { keep = tracePlain(world.scene, rays); });
    m.tracer_rays_per_s.push_back(static_cast<double>(m.rays) / traced);
    m.plain_rays_per_s.push_back(static_cast<double>(rays.size()) / plain);
    m.ratio.push_back(m.tracer_rays_per_s.back() / m.plain_rays_per_s.back());
  }
  static_cast<void>(keep);
  return m;
}

}  // namespace nephroid
