#include "techniques/reference/light_tracer.h"

#include <algorithm>
#include <cmath>

#include "techniques/reference/light_path.h"
#include "techniques/reference/photon_order.h"

namespace nephroid {
namespace {

/// Photons that are put in order together: many, so that neighbours are near.
constexpr std::uint32_t kWavePhotons = 4096;
/// Photons that are on their way together: several packets, few enough to stay in the cache.
constexpr std::size_t kGroupPhotons = 32;

/// The photons of one run, in waves that are emitted, put in order and traced in groups.
/// Sums are in an order that depends on the photons alone, never on threads.
class PhotonRun {
 public:
  PhotonRun(const LightPathContext& context, const Emitter& emitter, const PhotonOrder& order)
      : context_(context), emitter_(emitter), order_(order) {}

  /// @param sampler_of  the numbers of a photon by its index
  template <class SamplerOf>
  void traceWave(std::uint32_t begin, std::uint32_t end, SamplerOf&& sampler_of) {
    photons_.clear();
    keys_.clear();
    for (std::uint32_t i = begin; i < end; ++i) emit(sampler_of(i));
    const std::vector<std::uint32_t> order = PhotonOrder::sort(keys_);
    for (std::size_t first = 0; first < order.size(); first += kGroupPhotons) {
      group_.clear();
      for (std::size_t i = first; i < std::min(first + kGroupPhotons, order.size()); ++i) {
        const auto& [photon, sampler] = photons_[order[i]];
        group_.emplace_back(context_, emitter_, photon, sampler);
        // Tracing a group drives all else out of the cache: the photons of the next are fetched meanwhile.
        if (i + kGroupPhotons < order.size()) __builtin_prefetch(&photons_[order[i + kGroupPhotons]]);
      }
      traceGroup();
    }
  }

 private:
  void emit(Sampler sampler) {
    const EmittedPhoton photon = emitter_.emit(sampler);
    if (!isFinite(photon.flux)) {
      ++context_.tally.not_finite;
      return;
    }
    context_.tally.ledger.emitted += dvec3(photon.flux);
    if (photon.flux == vec3(0.0F)) return;
    photons_.push_back({photon, sampler});
    keys_.push_back(order_.keyOf(photon.origin, photon.dir));
  }

  void traceGroup() {
    live_.clear();
    for (LightPath& path : group_)
      if (path.alive()) live_.push_back(&path);
    while (!live_.empty()) {
      hits_.resize(live_.size());
      rays_.clear();
      for (const LightPath* path : live_) rays_.push_back(&path->ray());
      for (std::size_t i = 0; i < rays_.size(); i += TraceScene::kPacketSize)
        context_.world.scene.intersectPacket(
            std::span(rays_).subspan(i, std::min(TraceScene::kPacketSize, rays_.size() - i)), &hits_[i]);
      for (std::size_t i = 0; i < live_.size(); ++i) live_[i]->arrive(hits_[i]);
      std::erase_if(live_, [](const LightPath* path) { return !path->alive(); });
    }
  }

  const LightPathContext& context_;
  const Emitter& emitter_;
  const PhotonOrder& order_;
  struct Emitted {
    EmittedPhoton photon;
    Sampler sampler;
  };
  std::vector<Emitted> photons_;
  std::vector<std::uint32_t> keys_;  ///< by photon
  std::vector<LightPath> group_;
  std::vector<LightPath*> live_;  ///< into group_
  std::vector<const Ray*> rays_;  ///< by live path
  std::vector<RayHit> hits_;      ///< by live path
};

}  // namespace

LightTracer::LightTracer(const ReferenceWorld& world, bool continue_after_diffuse, bool keep_deposits)
    : world_(world), continue_after_diffuse_(continue_after_diffuse), keep_deposits_(keep_deposits) {
  const SceneData& data = world.scene.scene();
  for (const Instance& instance : data.instances) {
    const Classification c = classify(data, data.materialOf(instance), world.options.specular_alpha);
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

void LightTracer::trace(std::size_t emitter, std::uint32_t begin, std::uint32_t end, PhotonTally& tally) const {
  // Streams of pixels count up from 0; those of lights down from the top.
  const std::uint32_t stream = 0xFFFFFFFFU - static_cast<std::uint32_t>(emitter);
  const auto sampler_of = [&](std::uint32_t i) { return Sampler(world_.options.seed, stream, i); };
  CameraConnections connections(world_.walker, tally);
  const LightPathContext context{world_, is_target_, continue_after_diffuse_, keep_deposits_, tally, connections};
  const PhotonOrder order(targets_->bounds());
  PhotonRun run(context, *emitters_[emitter], order);
  for (std::uint32_t i = begin; i < end;) {
    const std::uint32_t wave = std::min(kWavePhotons, end - i);
    run.traceWave(i, i + wave, sampler_of);
    i += wave;
  }
  connections.flush();
  tally.ledger.emitted_count += end - begin;
}

}  // namespace nephroid
