#include "techniques/reference/light_tracer.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "techniques/reference/light_path.h"

namespace nephroid {
namespace {

/// Photons that are on their way together: several packets, few enough to stay in the cache.
constexpr std::size_t kGroupPhotons = 32;

/// Traces photons in groups. Sums are in an order that depends on the photons alone, never on threads.
class GroupTracer {
 public:
  /// @param normal_of  of the light where a photon left it, by its index; asked where photons carry weights
  GroupTracer(const LightPathContext& context, const Emitter& emitter,
              const std::function<vec3(std::uint64_t)>& normal_of)
      : context_(context), emitter_(emitter), normal_of_(normal_of) {}

  /// Traces photons [begin, end) of a wave's order, at most kGroupPhotons.
  void trace(const PhotonWave& wave, std::size_t begin, std::size_t end) {
    group_.clear();
    live_.clear();
    for (std::size_t i = begin; i < end; ++i) {
      group_.emplace_back(context_, emitter_, wave[i].emitted, wave[i].sampler);
      if (context_.vcm) group_.back().carryWeights(emitter_, normal_of_(wave.indexOf(i)));
      // Tracing a group drives all else out of the cache: the photons of the next are fetched meanwhile.
      wave.prefetch(i + kGroupPhotons);
    }
    for (LightPath& path : group_)
      if (path.alive()) live_.push_back(&path);
    while (!live_.empty()) step();
  }

 private:
  void step() {
    hits_.resize(live_.size());
    rays_.clear();
    for (const LightPath* path : live_) rays_.push_back(&path->ray());
    for (std::size_t i = 0; i < rays_.size(); i += TraceScene::kPacketSize)
      context_.world.scene.intersectPacket(
          std::span(rays_).subspan(i, std::min(TraceScene::kPacketSize, rays_.size() - i)), &hits_[i]);
    for (std::size_t i = 0; i < live_.size(); ++i) live_[i]->arrive(hits_[i]);
    std::erase_if(live_, [](const LightPath* path) { return !path->alive(); });
  }

  const LightPathContext& context_;
  const Emitter& emitter_;
  const std::function<vec3(std::uint64_t)>& normal_of_;
  std::vector<LightPath> group_;
  std::vector<LightPath*> live_;  ///< into group_
  std::vector<const Ray*> rays_;  ///< by live path
  std::vector<RayHit> hits_;      ///< by live path
};

}  // namespace

LightTracer::LightTracer(const ReferenceWorld& world, const PhotonPaths& connect) : world_(world), connect_(connect) {
  const SceneData& data = world.scene.scene();
  const std::vector<Classification> classes = classifyMaterials(data, world.options.specular_alpha);
  for (const Instance& instance : data.instances) {
    const Classification& c = classes[data.meshes[instance.mesh].material];
    is_target_.push_back(instance.casts && (c.is_generator || c.is_weak_generator));
  }
  targets_ = std::make_unique<EmissionTargets>(world.scene, is_target_);
  emitters_ = makeEmitters(world.scene, world.materials, world.lights, *targets_);
}

std::vector<std::uint32_t> LightTracer::sharePhotons(std::uint32_t total) const {
  double sum = 0.0;
  for (const auto& emitter : emitters_) sum += luminance(emitter->expectedFlux());
  std::vector<std::uint32_t> shares;
  for (const auto& emitter : emitters_) {
    const double share = luminance(emitter->expectedFlux()) / sum;
    shares.push_back(std::max<std::uint32_t>(1, static_cast<std::uint32_t>(std::lround(share * total))));
  }
  return shares;
}

Sampler LightTracer::samplerOf(std::size_t emitter, std::uint64_t photon) const {
  // Streams of pixels count up from 0; those of lights down from the top, one for every 2³² photons.
  const auto round = static_cast<std::uint32_t>(photon >> 32);
  const std::uint32_t stream = 0xFFFFFFFFU - static_cast<std::uint32_t>(emitter + round * emitters_.size());
  return Sampler(world_.options.seed, stream, static_cast<std::uint32_t>(photon));
}

vec3 LightTracer::lightNormalOf(std::size_t emitter, std::uint64_t photon) const {
  // Emitted once more: it has no room in what is kept of a photon.
  Sampler sampler = samplerOf(emitter, photon);
  vec3 normal;
  emitters_[emitter]->emit(sampler, normal);
  return normal;
}

void LightTracer::emit(std::size_t emitter, std::uint32_t begin, std::uint32_t end, PhotonWave& wave,
                       PhotonTally& tally) const {
  const MortonOrder order(targets_->bounds());
  for (std::uint32_t i = begin; i < end; ++i) {
    Sampler sampler = samplerOf(emitter, wave.first() + i);
    const EmittedPhoton photon = emitters_[emitter]->emit(sampler);
    if (!isFinite(photon.flux)) {
      ++tally.not_finite;
      continue;
    }
    tally.ledger.emitted += dvec3(photon.flux);
    if (photon.flux != vec3(0.0F)) wave.put(i, {photon, sampler}, order.keyOf(photon.origin, photon.dir));
  }
  tally.ledger.emitted_count += end - begin;
}

void LightTracer::trace(std::size_t emitter, const PhotonWave& wave, std::uint32_t begin, std::uint32_t end,
                        const FootprintScale& spread, PhotonTally& tally) const {
  CameraConnections connections(world_.walker, view_, tally);
  FootprintScale kept = spread;
  if (!view_) kept.cell = 0.0F;
  if (!keep_deposits_) kept.gathered_cell = 0.0F;
  const LightPathContext context{.world = world_,
                                 .is_target = is_target_,
                                 .connect_indirect = connect_.indirect,
                                 .connect_caustics = connect_.caustic,
                                 .keep_caustic_deposits = keep_deposits_,
                                 .keep_indirect_deposits = keep_indirect_deposits_,
                                 .spread = kept,
                                 .tally = tally,
                                 .connections = connections,
                                 .vcm = vcm_,
                                 .leave_walked = leave_walked_};
  const std::function<vec3(std::uint64_t)> normal_of = [&](std::uint64_t p) { return lightNormalOf(emitter, p); };
  GroupTracer group(context, *emitters_[emitter], normal_of);
  for (std::size_t i = begin; i < end; i += kGroupPhotons)
    group.trace(wave, i, std::min<std::size_t>(i + kGroupPhotons, end));
  connections.flush();
}

PhotonTally LightTracer::traceAlone(std::size_t emitter, const PhotonWave::Photon& photon,
                                    const FootprintScale& spread) const {
  PhotonTally tally;
  CameraConnections connections(world_.walker, nullptr, tally);
  const LightPathContext context{.world = world_,
                                 .is_target = is_target_,
                                 .connect_indirect = false,
                                 .connect_caustics = connect_.caustic,
                                 .keep_caustic_deposits = keep_deposits_,
                                 .keep_indirect_deposits = false,
                                 .spread = spread,
                                 .tally = tally,
                                 .connections = connections};
  LightPath path(context, *emitters_[emitter], photon.emitted, photon.sampler);
  while (path.alive()) {
    RayHit hit;
    if (!world_.scene.intersect(path.ray(), hit)) hit.instance = kNone;
    path.arrive(hit);
  }
  connections.flush();
  return tally;
}

std::optional<FootprintSplat> LightTracer::findLanding(std::size_t emitter, const PhotonWave::Photon& photon,
                                                       const FootprintScale& spread) const {
  const PhotonTally tally = traceAlone(emitter, photon, spread);
  if (tally.footprints.empty()) return std::nullopt;
  return tally.footprints.front();
}

}  // namespace nephroid
