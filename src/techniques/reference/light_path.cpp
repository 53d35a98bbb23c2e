#include "techniques/reference/light_path.h"

#include <algorithm>
#include <cmath>

namespace nephroid {
namespace {

/// Events before Russian roulette may end a photon: it only ends what absorption has made weak.
constexpr int kRouletteStart = 8;

/// Share of the photons that leave deposits after their first, each for all the others. What a caustic lights in turn
/// is spread evenly and far dimmer: a quarter of the photons shows it with less noise than the caustic has, and their
/// rays cost a few per cent.
constexpr float kIndirectShare = 1.0F / 4.0F;

}  // namespace

void CameraConnections::flush() {
  if (count_ == 0) return;
  std::array<vec3, TraceScene::kPacketSize> visible;
  walker_.visibility({lines_.data(), count_}, visible.data(), tally_.rays);
  for (std::size_t i = 0; i < count_; ++i) {
    if (maxComponent(visible[i]) <= 0.0F) continue;
    Splat& splat = splats_[i];
    splat.radiance *= visible[i];
    splat.irradiance *= visible[i];
    if (isFinite(splat.radiance) && isFinite(splat.irradiance))
      keep(splat, footprints_[i]);
    else
      ++tally_.not_finite;
  }
  count_ = 0;
}

void CameraConnections::keep(const Splat& splat, std::optional<FootprintSplat>& footprint) {
  if (footprint) footprint->splat = splat;
  if (footprint && (!view_ || normalizeFootprint(*view_, *footprint))) {
    tally_.footprints.push_back(*footprint);
  } else {
    tally_.splats.push_back(splat);
  }
}

LightPath::LightPath(const LightPathContext& context, const Emitter& emitter, const EmittedPhoton& photon,
                     Sampler sampler)
    : context_(&context),
      ledger_(&context.tally.ledger),
      sampler_(sampler),
      state_{Ray{photon.origin, photon.dir}, emitter.interior()},
      flux_(photon.flux),
      emitted_(photon.flux),
      footprint_(context.spread.any() ? emitter.extentOf(photon) : EmissionExtent{}, photon.dir),
      share_(emitter.source() == context.world.lights.sourceOfEnvironment()) {
  if (!context.spread.any()) footprint_.lose();
  depart();
}

void LightPath::arrive(const RayHit& hit) {
  const Walker& walker = context_->world.walker;
  if (!walker.arrive(state_, sampler_, encounter_, hit)) return;
  context_->tally.rays += encounter_.rays;
  if (encounter_.hit) footprint_.transfer(state_.ray.dir, encounter_.distance, encounter_.point);
  alive_ = endStep() && scatter();
  ++bounce_;
  if (alive_) depart();
  if (alive_) return;
  ledger_->roulette_squared += roulette_ * roulette_;
  ledger_->roulette += roulette_;
}

void LightPath::depart() {
  Walker::depart(encounter_);
  if (bounce_ < context_->world.options.max_bounces) return;
  lose(LossReason::kBounceLimit, flux());
  alive_ = false;
}

void LightPath::lose(LossReason reason, vec3 flux) {
  if (reason == LossReason::kNumerical) ++context_->tally.not_finite;
  if (accounted()) ledger_->lost[static_cast<std::size_t>(reason)] += dvec3(flux);
}

bool LightPath::endStep() {
  if (encounter_.transmittance != vec3(1.0F)) {
    const vec3 before = flux();
    const vec3 kept = before * encounter_.transmittance;
    if (!isFinite(kept)) {
      lose(LossReason::kNumerical, before);
      return false;
    }
    if (accounted()) ledger_->absorbed += dvec3(before) - dvec3(kept);
    flux_ *= encounter_.transmittance;
  }
  if (encounter_.overflow) {
    lose(LossReason::kInteriorOverflow, flux());
    return false;
  }
  if (!encounter_.hit) {
    if (accounted()) (stage_ == Stage::kEmitted ? ledger_->missed : ledger_->escaped) += dvec3(flux());
    return false;
  }
  return flux_ != vec3(0.0F);
}

bool LightPath::scatter() {
  const ReferenceOptions& options = context_->world.options;
  if (stage_ == Stage::kEmitted && !context_->is_target[encounter_.point.instance] && !encounter_.material->is_pane) {
    ledger_->blocked += dvec3(flux());
    return false;
  }
  const vec3 wo = -state_.ray.dir;
  const vec3 before = flux();
  drawWavelength(state_, encounter_, options.spectral, sampler_);
  const float ior_from = iorOf(encounter_.boundary.from, state_.wavelength_nm);
  const float ior_to = iorOf(encounter_.boundary.to, state_.wavelength_nm);
  const Bsdf bsdf(*encounter_.material, encounter_.point, wo, ior_from, ior_to, options.specular_alpha);
  if (!bsdf.isClear()) settleWavelength(state_, encounter_);
  const vec3 weighted = flux();
  // The interface's share goes on as S; the rest is the base's (or, without a base, is absorbed).
  const vec3 specular_share = bsdf.hasSpecular() ? bsdf.interfaceAlbedo() : vec3(0.0F);
  const vec3 rest = weighted * (1.0F - specular_share);
  // Not finite either if `weighted` is not: nothing of this event has been accounted for yet.
  if (!isFinite(rest)) {
    lose(LossReason::kNumerical, before);
    return false;
  }
  if (accounted() && weighted != before) roulette_ += dvec3(before) - dvec3(weighted);
  const bool weighs = trail_.carried() && accounted();
  if (weighs) trail_.arrive(encounter_.point, state_.ray.dir, bsdf.isEvaluable(EventClass::kSpecular));
  if (weighs && trail_.connects() && bsdf.isEvaluable(EventClass::kSpecular))
    context_->tally.vcm_rough.push_back(trail_.vertexAt(surface(), wo, weighted, EventClass::kSpecular));
  if (!bsdf.hasDiffuse()) {
    if (accounted()) ledger_->absorbed += dvec3(rest);
  } else if (stage_ == Stage::kEmitted) {
    ledger_->blocked += dvec3(rest);
  } else {
    const bool first = stage_ == Stage::kSpecularChain;
    if (first) {
      ledger_->deposited += dvec3(rest);
      if (!isLeft()) deposit(bsdf, weighted, wo);
    } else if (deposits_again_) {
      depositAgain(weighted * bsdf.shadingCosineRatio(wo));
    }
    if (!isLeft() && (first ? context_->connect_caustics : context_->connect_indirect)) connectToCamera(bsdf, wo);
  }
  return continueWith(bsdf, specular_share, wo);
}

void LightPath::deposit(const Bsdf& bsdf, vec3 weighted, vec3 wo) {
  PhotonTally& tally = context_->tally;
  const vec3 counted = weighted * bsdf.shadingCosineRatio(wo);
  if (context_->keep_caustic_deposits) {
    GridPhoton& photon = tally.caustic_deposits.emplace_back(
        GridPhoton{encounter_.point.position, state_.ray.dir, counted, encounter_.point.normal_geometric});
    if (footprint_.valid() && context_->spread.gathered_cell > 0.0F)
      photon.axes = footprint_.halfAxesOn(photon.normal, context_->spread.gathered_cell);
  }
  if (!trail_.carried()) return;
  tally.vcm_photons.push_back(trail_.photonAt(encounter_.point, wo, counted));
  if (trail_.connects()) tally.vcm_ends.push_back(trail_.vertexAt(surface(), wo, weighted, EventClass::kDiffuse));
}

void LightPath::depositAgain(vec3 weighted) {
  context_->tally.indirect_deposits.push_back(
      {encounter_.point.position, state_.ray.dir, weighted / kIndirectShare, encounter_.point.normal_geometric});
}

bool LightPath::continueWith(const Bsdf& bsdf, vec3 specular_share, vec3 wo) {
  const float p_specular = bsdf.specularProbability();
  const bool beyond_diffuse = context_->connect_indirect || context_->keep_indirect_deposits;
  const bool diffuse_allowed = beyond_diffuse && stage_ != Stage::kEmitted && bsdf.hasDiffuse();
  const vec3 specular_flux = flux() * specular_share;
  const bool must_choose = bsdf.hasDiffuse();
  const bool specular = p_specular > 0.0F && (!must_choose || sampler_.next1D() < p_specular);
  const float p_class = !must_choose ? 1.0F : specular ? p_specular : 1.0F - p_specular;
  if (!specular) {
    if (accounted()) roulette_ += dvec3(specular_flux);
    if (!diffuse_allowed || p_class <= 0.0F) return false;
    return scatterDiffuse(bsdf, p_class, wo);
  }
  if (p_class == 1.0F) return scatterSpecular(bsdf, specular_flux, p_class);
  const vec3 carried = specular_flux / p_class;
  if (!isFinite(carried)) {
    lose(LossReason::kNumerical, specular_flux);
    return false;
  }
  if (accounted()) roulette_ += dvec3(specular_flux) - dvec3(carried);
  return scatterSpecular(bsdf, carried, p_class);
}

bool LightPath::scatterSpecular(const Bsdf& bsdf, vec3 carried, float p_class) {
  const vec2 u = bsdf.isEvaluable(EventClass::kSpecular) ? sampler_.next2D() : vec2(0.0F);
  const auto s = bsdf.sample(EventClass::kSpecular, u, sampler_.next1D(), Transport::kFlux);
  const bool smooth = encounter_.material->alpha == 0.0F;
  if (!s) {
    lose(smooth ? LossReason::kShadingNormal : LossReason::kMicrofacet, carried);
    return false;
  }
  followWavelengths(state_, encounter_, -state_.ray.dir, context_->world.options.specular_alpha, s->transmitted);
  const vec3 unweighted = flux_ * (s->weight / p_class);
  const vec3 out = unweighted * state_.hero.weight;
  if (!isFinite(out)) {
    lose(LossReason::kNumerical, carried);
    return false;
  }
  if (accounted()) {
    const dvec3 difference = dvec3(carried) - dvec3(out);
    if (smooth)
      roulette_ += difference;
    else
      ledger_->lost[static_cast<std::size_t>(LossReason::kMicrofacet)] += difference;
  }
  flux_ = unweighted;
  if (!s->pass && stage_ == Stage::kEmitted) stage_ = Stage::kSpecularChain;
  if (!s->pass) share_.add(encounter_, -state_.ray.dir, s->dir, context_->world.options.specular_alpha);
  if (trail_.carried() && accounted()) trail_.scatter(surface(), -state_.ray.dir, *s, p_class);
  bendFootprint(*s, p_class);
  return leave(*s);
}

void LightPath::bendFootprint(const BsdfSample& s, float p_class) {
  if (!footprint_.valid()) return;
  footprint_.choose(p_class * s.probability);
  const float ior_from = iorOf(encounter_.boundary.from, state_.wavelength_nm);
  const float ior_to = iorOf(encounter_.boundary.to, state_.wavelength_nm);
  footprint_.bend(context_->world.scene, encounter_.point, state_.ray.dir, s.dir, s.transmitted,
                  encounter_.material->is_solid ? ior_from / ior_to : 1.0F);
}

bool LightPath::scatterDiffuse(const Bsdf& bsdf, float p_class, vec3 wo) {
  if (stage_ == Stage::kSpecularChain && context_->keep_indirect_deposits)
    deposits_again_ = sampler_.next1D() < kIndirectShare;
  stage_ = Stage::kAfterDiffuse;
  if (!deposits_again_ && !context_->connect_indirect) return false;
  const vec2 u = sampler_.next2D();
  const auto s = bsdf.sample(EventClass::kDiffuse, u, sampler_.next1D(), Transport::kFlux);
  footprint_.lose();
  if (!s) return false;
  // Flux arrives on the true surface and leaves from it; the BSDF counts both cosines on the shaded one.
  const float leaving = bsdf.shadingCosineRatio(s->dir);
  if (leaving <= 0.0F) return false;
  const vec3 kept = s->weight * (bsdf.shadingCosineRatio(wo) / leaving / p_class);
  flux_ *= kept;
  if (!isFinite(flux_)) {
    lose(LossReason::kNumerical, flux_);  // deposited long since: only counted
    return false;
  }
  return staysUseful(maxComponent(kept)) && leave(*s);
}

/// Photons that are only gathered tell most where all carry the same: what a surface keeps of their flux, `kept`,
/// becomes the chance to go on.
bool LightPath::staysUseful(float kept) {
  if (context_->connect_indirect || kept >= 1.0F) return true;
  if (kept <= 0.0F || sampler_.next1D() >= kept) return false;
  flux_ /= kept;
  return true;
}

bool LightPath::leave(const BsdfSample& s) {
  if (!updateInterior(context_->world.scene, encounter_, s.transmitted, state_.interior)) {
    lose(LossReason::kInteriorOverflow, flux());
    return false;
  }
  state_.ray = Ray{offsetOrigin(encounter_.point, s.dir), s.dir};
  return bounce_ < kRouletteStart || survives();
}

bool LightPath::survives() {
  const float left = maxComponent(glm::abs(flux_)) / maxComponent(glm::abs(emitted_));
  // Below one in ten of what it began with, a photon is hardly worth its rays.
  const float q = std::min(10.0F * left, 1.0F);
  if (q >= 1.0F) return true;
  const bool alive = sampler_.next1D() < q;
  const vec3 before = flux();
  flux_ = alive ? flux_ / q : vec3(0.0F);
  if (accounted()) roulette_ += dvec3(before) - dvec3(flux());
  return alive;
}

void LightPath::connectToCamera(const Bsdf& bsdf, vec3 wo) {
  const CameraModel& camera = context_->world.camera_model;
  const auto c = camera.connect(encounter_.point.position);
  if (!c) return;
  const BsdfValue value = bsdf.evaluate(EventClass::kDiffuse, c->dir, Transport::kFlux);
  if (maxComponent(value.f) <= 0.0F) return;
  const float cos_camera = dot(c->dir, encounter_.point.normal_geometric);
  const bool same_side = (cos_camera > 0.0F) == encounter_.boundary.entering;
  const Material* medium = same_side ? encounter_.boundary.from : encounter_.boundary.to;
  const Ray line{offsetOrigin(encounter_.point, c->dir), c->dir, c->distance};
  const bool weighs = trail_.carried() && stage_ == Stage::kSpecularChain;
  const float weight = weighs ? trail_.weighSeenAt(surface(), wo, c->dir, c->importance) : 1.0F;
  const float scale = std::abs(cos_camera) * bsdf.shadingCosineRatio(wo) * c->importance * weight;
  const vec3 irradiance = same_side ? flux() * scale : vec3(0.0F);
  const Splat splat{static_cast<std::uint32_t>(c->y * camera.width() + c->x), stage_ == Stage::kSpecularChain,
                    flux() * value.f * scale, irradiance};
  // What varies over the surface would be blurred: there, a photon counts for its own pixel.
  const bool varies = encounter_.material == &encounter_.scratch;
  if (varies || !footprint_.valid())
    context_->connections.add({line, medium}, splat);
  else
    context_->connections.add({line, medium}, splat,
                              makeFootprintSplat(footprint_, context_->spread, camera, encounter_.point, c->film));
}

}  // namespace nephroid
