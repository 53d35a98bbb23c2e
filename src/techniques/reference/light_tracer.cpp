#include "techniques/reference/light_tracer.h"

#include <algorithm>
#include <cmath>

#include "trace/bsdf.h"

namespace nephroid {
namespace {

/// Events before Russian roulette may end a photon: it only ends what absorption has made weak.
constexpr int kRouletteStart = 8;

enum class Stage : std::uint8_t { kEmitted, kSpecularChain, kAfterDiffuse };

/// One photon on its way from a light.
class LightPath {
 public:
  LightPath(const ReferenceWorld& world, const std::vector<bool>& is_target, bool continue_after_diffuse,
            PhotonTally& tally, Sampler sampler)
      : world_(world), is_target_(is_target), continue_after_diffuse_(continue_after_diffuse), tally_(tally),
        ledger_(tally.ledger), sampler_(sampler) {}

  void trace(const Emitter& emitter) {
    const EmittedPhoton photon = emitter.emit(sampler_);
    if (!isFinite(photon.flux)) {
      ++tally_.not_finite;
      return;
    }
    flux_ = emitted_ = photon.flux;
    ledger_.emitted += dvec3(flux_);
    if (flux_ == vec3(0.0F)) return;
    state_.ray = Ray{photon.origin, photon.dir};
    state_.interior = emitter.interior();
    for (int bounce = 0;; ++bounce) {
      if (bounce == world_.options.max_bounces) {
        lose(LossReason::kBounceLimit, flux_);
        break;
      }
      if (!advance(bounce) || !scatter(bounce)) break;
    }
    ledger_.roulette_squared += roulette_ * roulette_;
    ledger_.roulette += roulette_;
  }

 private:
  bool accounted() const { return stage_ != Stage::kAfterDiffuse; }
  void lose(LossReason reason, vec3 flux) {
    if (accounted()) ledger_.lost[static_cast<std::size_t>(reason)] += dvec3(flux);
  }

  /// To the next surface. @return false if the photon ends
  bool advance(int bounce) {
    world_.walker.advance(state_, sampler_, encounter_, bounce == 0);
    tally_.rays += encounter_.rays;
    const vec3 kept = flux_ * encounter_.transmittance;
    if (accounted()) ledger_.absorbed += dvec3(flux_) - dvec3(kept);
    flux_ = kept;
    if (encounter_.overflow) {
      lose(LossReason::kInteriorOverflow, flux_);
      return false;
    }
    if (!encounter_.hit) {
      if (accounted()) (stage_ == Stage::kEmitted ? ledger_.missed : ledger_.escaped) += dvec3(flux_);
      return false;
    }
    return flux_ != vec3(0.0F);
  }

  /// @return false if the photon ends
  bool scatter(int bounce) {
    if (stage_ == Stage::kEmitted && !is_target_[encounter_.point.instance] && !encounter_.material->is_pane) {
      ledger_.blocked += dvec3(flux_);
      return false;
    }
    const vec3 wo = -state_.ray.dir;
    const vec3 weight = drawWavelength(state_, encounter_.boundary, world_.options.spectral, sampler_);
    if (accounted()) roulette_ += dvec3(flux_) - dvec3(flux_ * weight);
    flux_ *= weight;
    const float ior_from = iorOf(encounter_.boundary.from, state_.wavelength_nm);
    const float ior_to = iorOf(encounter_.boundary.to, state_.wavelength_nm);
    const Bsdf bsdf(*encounter_.material, encounter_.point, wo, ior_from, ior_to, world_.options.specular_alpha);
    // The interface's share goes on as S; the rest is the base's (or, without a base, is absorbed).
    const vec3 specular_share = bsdf.hasSpecular() ? bsdf.interfaceAlbedo() : vec3(0.0F);
    const vec3 rest = flux_ * (1.0F - specular_share);
    if (!bsdf.hasDiffuse()) {
      if (accounted()) ledger_.absorbed += dvec3(rest);
    } else if (stage_ == Stage::kEmitted) {
      ledger_.blocked += dvec3(rest);
    } else {
      if (stage_ == Stage::kSpecularChain) ledger_.deposited += dvec3(rest);
      connectToCamera(bsdf, wo);
    }
    return continueWith(bsdf, specular_share, wo, bounce);
  }

  bool continueWith(const Bsdf& bsdf, vec3 specular_share, vec3 wo, int bounce) {
    const float p_specular = bsdf.specularProbability();
    const bool diffuse_allowed = continue_after_diffuse_ && stage_ != Stage::kEmitted && bsdf.hasDiffuse();
    const vec3 specular_flux = flux_ * specular_share;
    const bool must_choose = bsdf.hasDiffuse();
    const bool specular = p_specular > 0.0F && (!must_choose || sampler_.next1D() < p_specular);
    const float p_class = !must_choose ? 1.0F : specular ? p_specular : 1.0F - p_specular;
    if (!specular) {
      if (accounted()) roulette_ += dvec3(specular_flux);
      if (!diffuse_allowed || p_class <= 0.0F) return false;
      return scatterDiffuse(bsdf, p_class, wo, bounce);
    }
    const vec3 carried = specular_flux / p_class;
    if (accounted()) roulette_ += dvec3(specular_flux) - dvec3(carried);
    const vec2 u = bsdf.isEvaluable(EventClass::kSpecular) ? sampler_.next2D() : vec2(0.0F);
    const auto s = bsdf.sample(EventClass::kSpecular, u, sampler_.next1D(), Transport::kFlux);
    const bool smooth = encounter_.material->alpha == 0.0F;
    if (!s) {
      lose(smooth ? LossReason::kShadingNormal : LossReason::kMicrofacet, carried);
      return false;
    }
    const vec3 out = flux_ * s->weight / p_class;
    if (accounted()) {
      const dvec3 difference = dvec3(carried) - dvec3(out);
      if (smooth)
        roulette_ += difference;
      else
        ledger_.lost[static_cast<std::size_t>(LossReason::kMicrofacet)] += difference;
    }
    flux_ = out;
    if (!s->pass && stage_ == Stage::kEmitted) stage_ = Stage::kSpecularChain;
    return leave(*s, bounce);
  }

  bool scatterDiffuse(const Bsdf& bsdf, float p_class, vec3 wo, int bounce) {
    const vec2 u = sampler_.next2D();
    const auto s = bsdf.sample(EventClass::kDiffuse, u, sampler_.next1D(), Transport::kFlux);
    stage_ = Stage::kAfterDiffuse;
    if (!s) return false;
    // Flux arrives on the true surface and leaves from it; the BSDF counts both cosines on the shaded one.
    const float leaving = bsdf.shadingCosineRatio(s->dir);
    if (leaving <= 0.0F) return false;
    flux_ *= s->weight * (bsdf.shadingCosineRatio(wo) / leaving / p_class);
    return leave(*s, bounce);
  }

  bool leave(const BsdfSample& s, int bounce) {
    if (!isFinite(flux_)) {
      ++tally_.not_finite;
      return false;
    }
    if (encounter_.material->is_solid) {
      const std::uint32_t solid = world_.scene.solidOf(encounter_.point.instance);
      const Material& material = *encounter_.material->source;
      const bool entering = encounter_.boundary.entering;
      if (!(s.transmitted ? crossInterface(state_.interior, solid, material, entering)
                          : reflectInside(state_.interior, solid, material, entering))) {
        lose(LossReason::kInteriorOverflow, flux_);
        return false;
      }
    }
    state_.ray = Ray{offsetOrigin(encounter_.point, s.dir), s.dir};
    return bounce < kRouletteStart || survives();
  }

  bool survives() {
    const float left = maxComponent(glm::abs(flux_)) / maxComponent(glm::abs(emitted_));
    // Below one in ten of what it began with, a photon is hardly worth its rays.
    const float q = std::min(10.0F * left, 1.0F);
    if (q >= 1.0F) return true;
    const bool alive = sampler_.next1D() < q;
    const vec3 kept = alive ? flux_ / q : vec3(0.0F);
    if (accounted()) roulette_ += dvec3(flux_) - dvec3(kept);
    flux_ = kept;
    return alive;
  }

  void connectToCamera(const Bsdf& bsdf, vec3 wo) {
    const auto c = world_.camera_model.connect(encounter_.point.position);
    if (!c) return;
    const BsdfValue value = bsdf.evaluate(EventClass::kDiffuse, c->dir, Transport::kFlux);
    if (maxComponent(value.f) <= 0.0F) return;
    const float cos_camera = dot(c->dir, encounter_.point.normal_geometric);
    const bool same_side = (cos_camera > 0.0F) == encounter_.boundary.entering;
    const Material* medium = same_side ? encounter_.boundary.from : encounter_.boundary.to;
    const Ray line{offsetOrigin(encounter_.point, c->dir), c->dir, c->distance};
    const vec3 visible = world_.walker.visibility(line, medium, tally_.rays);
    if (maxComponent(visible) <= 0.0F) return;
    const float scale = std::abs(cos_camera) * bsdf.shadingCosineRatio(wo) * c->importance;
    const vec3 irradiance = same_side ? flux_ * visible * scale : vec3(0.0F);
    const vec3 radiance = flux_ * visible * value.f * scale;
    if (!isFinite(radiance) || !isFinite(irradiance)) {
      ++tally_.not_finite;
      return;
    }
    tally_.splats.push_back({static_cast<std::uint32_t>(c->y * world_.camera_model.width() + c->x),
                             stage_ == Stage::kSpecularChain, radiance, irradiance});
  }

  const ReferenceWorld& world_;
  const std::vector<bool>& is_target_;
  bool continue_after_diffuse_;
  PhotonTally& tally_;
  Ledger& ledger_;
  Sampler sampler_;
  PathState state_;
  Encounter encounter_;
  Stage stage_ = Stage::kEmitted;
  vec3 flux_{0.0F}, emitted_{0.0F};
  dvec3 roulette_{0.0};
};

}  // namespace

LightTracer::LightTracer(const ReferenceWorld& world, bool continue_after_diffuse)
    : world_(world), continue_after_diffuse_(continue_after_diffuse) {
  const SceneData& data = world.scene.scene();
  for (const Instance& instance : data.instances) {
    const Classification c = classify(data.materialOf(instance), world.options.specular_alpha);
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
  for (std::uint32_t i = begin; i < end; ++i)
    LightPath(world_, is_target_, continue_after_diffuse_, tally, Sampler(world_.options.seed, stream, i))
        .trace(*emitters_[emitter]);
  tally.ledger.emitted_count += end - begin;
}

}  // namespace nephroid
