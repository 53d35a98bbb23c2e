#include "techniques/reference/path_tracer.h"

#include <algorithm>
#include <cmath>

namespace nephroid {
namespace {

/// Events before Russian roulette begins: glass objects need a handful to be seen through.
constexpr int kRouletteStart = 6;

/// Walks on the specular manifold draw their numbers from a seed of their own: how many they take is left to chance.
constexpr std::uint32_t kWalkSeedOffset = 0x6D6E6565U;

float powerHeuristic(float pdf, float other) {
  if (!std::isfinite(pdf)) return 1.0F;
  const float a = pdf * pdf, b = other * other;
  return a > 0.0F ? a / (a + b) : 0.0F;
}

/// One path on its way from the eye.
class EyePath {
 public:
  EyePath(const ReferenceWorld& world, const LayerNeeds& needs, const GatheredPhotons* photons,
          const PhotonPaths& gathered, const PhotonPaths& left, const Manifold* manifold, Film& film,
          PathCounters& counters, std::size_t pixel, Sampler sampler, Sampler walk_sampler)
      : world_(world),
        needs_(needs),
        photons_(photons),
        gathered_(gathered),
        left_(left),
        manifold_(manifold),
        film_(film),
        counters_(counters),
        pixel_(pixel),
        sampler_(sampler),
        walk_sampler_(walk_sampler) {}

  void trace(vec2 film_position) {
    state_.ray = world_.camera_model.rayThrough(film_position);
    vertex_ = state_.ray.origin;
    state_.interior = world_.camera_interior;
    eye_ior_ = iorOf(state_.interior.medium(), 0.0F);
    // Panes and holes are no events; the limit on steps keeps two facing panes from holding a path for ever.
    for (int step = 0; step < 4 * world_.options.max_bounces; ++step) {
      if (!advance() || !scatter()) return;
    }
  }

 private:
  /// To the next surface; adds the light met on the way. @return false if the path ends
  bool advance() {
    const Ray whole = state_.ray;
    world_.walker.advance(state_, sampler_, encounter_, class_.count() == 0);
    counters_.rays += encounter_.rays;
    if (encounter_.overflow) return false;
    world_.lights.visitSpheres(vertex_, whole, encounter_.distance, [&](const LightSet::Met& met) { addMet(met); });
    throughput_ *= encounter_.transmittance;
    irradiance_throughput_ *= encounter_.transmittance;
    if (!encounter_.hit) {
      world_.lights.visitInfinity(state_.ray.dir, [&](const LightSet::Met& met) { addMet(met); });
      return false;
    }
    const LightSet::Met met = world_.lights.metSurface(vertex_, encounter_.point, state_.ray.dir);
    if (maxComponent(met.radiance) > 0.0F) addMet(met);
    return maxComponent(glm::abs(throughput_)) > 0.0F;
  }

  void addMet(const LightSet::Met& met) {
    const float weight = previous_is_delta_ ? 1.0F : powerHeuristic(previous_pdf_, met.pdf);
    add(class_, throughput_ * met.radiance * weight, irradiance_throughput_ * met.radiance * weight);
  }

  /// @return false if the path ends
  bool scatter() {
    const vec3 wo = -state_.ray.dir;
    drawWavelength(state_, encounter_, world_.options.spectral, sampler_);
    const float ior_from = iorOf(encounter_.boundary.from, state_.wavelength_nm);
    const float ior_to = iorOf(encounter_.boundary.to, state_.wavelength_nm);
    const Bsdf bsdf(*encounter_.material, encounter_.point, wo, ior_from, ior_to, world_.options.specular_alpha);
    if (!bsdf.isClear()) settleWavelength(state_, encounter_);
    for (const EventClass c : {EventClass::kSpecular, EventClass::kDiffuse})
      if (bsdf.isEvaluable(c) && isWanted(class_.with(c))) connectToLight(bsdf, c);
    if (photons_ && bsdf.hasDiffuse()) gather(bsdf);
    if (manifold_ && bsdf.hasDiffuse() && wantsWalk()) walkToLight(bsdf);
    return sampleNext(bsdf);
  }

  void gather(const Bsdf& bsdf) {
    if (class_.count() == 0 ? gathered_.caustic : gathered_.specular_caustic && class_.isEyeSpecular())
      gatherCaustic(bsdf);
    if (gathered_.specular_indirect && class_.isEyeSpecular()) gatherIndirect(bsdf);
  }

  /// What kernels about a point say of it.
  struct Gathered {
    vec3 radiance{0.0F};
    vec3 irradiance{0.0F};  ///< where it is seen directly
    vec3 inner{0.0F};       ///< part of the radiance: from the half of each kernel about its photon
  };
  Gathered gatherFrom(const KernelMap& map, const Bsdf& bsdf) {
    const SurfacePoint& point = encounter_.point;
    Gathered found;
    const bool seen_directly = class_.count() == 0;
    map.visitKernels(point.position, point.normal_geometric, [&](const KernelPhoton& photon, float distance_squared) {
      const vec3 wi = -photon.dir, incident = photon.flux * (photon.inverse_area * bsdf.shadingCosineRatio(wi));
      const vec3 value = incident * bsdf.evaluate(EventClass::kDiffuse, wi, Transport::kRadiance).f;
      found.radiance += value;
      if (distance_squared <= 0.5F * photon.radius_squared) found.inner += value;
      // As for light that is connected to the camera: on the side that the eye sees.
      if (seen_directly && dot(wi, point.normal_geometric) * dot(state_.ray.dir, point.normal_geometric) < 0.0F)
        found.irradiance += incident;
    });
    return found;
  }

  void gatherCaustic(const Bsdf& bsdf) {
    const KernelMap& map = photons_->caustics();
    if (map.empty()) return;
    const Gathered found = gatherFrom(map, bsdf);
    record(class_.with(EventClass::kDiffuse).with(EventClass::kSpecular), throughput_ * found.radiance,
           found.irradiance);
    FilmPlane& plane = class_.count() == 0 ? film_.caustic_bias : film_.specular_caustic_bias;
    if (!plane.active()) return;
    // Where light varies smoothly a kernel errs in proportion to its area at most (Knaus & Zwicker 2011), so by twice
    // what the whole says more than its half.
    const vec3 bias = 2.0F * state_.hero.weight * throughput_ * (found.radiance - 2.0F * found.inner);
    if (isFinite(bias)) plane.add(pixel_, bias);
  }

  void gatherIndirect(const Bsdf& bsdf) {
    const KernelMap& map = photons_->indirect();
    if (map.empty()) return;
    const PathClass path =
        class_.with(EventClass::kDiffuse).with(EventClass::kDiffuse).with(EventClass::kSpecular);  // for one
    record(path, throughput_ * gatherFrom(map, bsdf).radiance, vec3(0.0F));
  }

  bool wantsWalk() const {
    if (class_.isEyeSpecular()) return needs_.throughSpecular();
    return class_.count() == 0 && (needs_.caustic || needs_.irradiance || needs_.irradiance_caustic);
  }
  void walkToLight(const Bsdf& bsdf) {
    const auto light = manifold_->estimate(encounter_, state_.interior, -state_.ray.dir, walk_sampler_, counters_.rays);
    if (!light) return;
    const vec3 incident = light->irradiance * bsdf.shadingCosineRatio(light->wi);
    const vec3 radiance = incident * bsdf.evaluate(EventClass::kDiffuse, light->wi, Transport::kRadiance).f;
    const vec3 normal = encounter_.point.normal_geometric;
    const bool seen_side = dot(light->wi, normal) * dot(state_.ray.dir, normal) < 0.0F;
    record(class_.with(EventClass::kDiffuse).with(EventClass::kSpecular), throughput_ * radiance,
           class_.count() == 0 && seen_side ? incident : vec3(0.0F));
  }

  /// Can a path that begins with these events still end in a layer that was asked for?
  bool mayContribute(const PathClass& c) const {
    if (c.count() == 0) return true;
    if (!c.firstIsDiffuse()) return needs_.specular || (needs_.throughSpecular() && c.mayBecomeSpecularCaustic());
    // Light that is met by chance counts in part for what was sampled towards lights, so it has to be looked for.
    if (c.count() == 1 && needs_.direct) return true;
    const bool caustic = !left_.caustic && (needs_.caustic || needs_.irradiance_caustic);
    return needs_.beyondDiffuse() || (caustic && c.mayBecomeCaustic());
  }
  bool isWanted(const PathClass& c) const {
    if (left_.include(c)) return false;
    if (c.firstIsDiffuse() && (needs_.irradiance || needs_.irradiance_caustic)) return true;
    return mayContribute(c) || c.layer() == PathLayer::kDirect;
  }

  void connectToLight(const Bsdf& bsdf, EventClass c) {
    const float u_choice = sampler_.next1D();
    const auto light = world_.lights.sample(encounter_.point.position, u_choice, sampler_.next2D());
    if (!light) return;
    const BsdfValue value = bsdf.evaluate(c, light->dir, Transport::kRadiance);
    const float cos_theta = std::abs(dot(light->dir, bsdf.normal()));
    if (maxComponent(value.f) <= 0.0F) return;
    const Ray shadow{offsetOrigin(encounter_.point, light->dir), light->dir, light->distance * kShadowEnd};
    const vec3 visible = world_.walker.visibility(shadow, mediumTowards(light->dir), counters_.rays);
    if (maxComponent(visible) <= 0.0F) return;
    const float p_class = c == EventClass::kSpecular ? bsdf.specularProbability() : 1.0F - bsdf.specularProbability();
    const float weight = light->delta ? 1.0F : powerHeuristic(light->pdf, p_class * value.pdf);
    const vec3 incident = visible * light->radiance * (cos_theta * weight / light->pdf);
    const PathClass path = class_.with(c);
    const vec3 irradiance = path.count() == 1 ? incident : irradiance_throughput_ * value.f * incident;
    add(path, throughput_ * value.f * incident, irradiance);
  }

  /// The medium on the side of the surface that `dir` leaves to.
  const Material* mediumTowards(vec3 dir) const {
    const bool same_side = (dot(dir, encounter_.point.normal_geometric) > 0.0F) ==
                           (dot(state_.ray.dir, encounter_.point.normal_geometric) < 0.0F);
    return same_side ? encounter_.boundary.from : encounter_.boundary.to;
  }

  bool sampleNext(const Bsdf& bsdf) {
    const float p_specular = bsdf.specularProbability();
    const bool specular = p_specular > 0.0F && sampler_.next1D() < p_specular;
    const EventClass c = specular ? EventClass::kSpecular : EventClass::kDiffuse;
    const float p_class = specular ? p_specular : 1.0F - p_specular;
    const vec2 u = sampler_.next2D();
    const auto s = bsdf.sample(c, u, sampler_.next1D(), Transport::kRadiance);
    if (!s) return false;
    followWavelengths(state_, encounter_, -state_.ray.dir, world_.options.specular_alpha, s->transmitted);
    throughput_ *= s->weight / p_class;
    irradiance_throughput_ *= s->weight / p_class;
    if (!s->pass) {
      if (!recordEvent(bsdf, c, *s, p_class)) return false;
      vertex_ = encounter_.point.position;
      previous_is_delta_ = s->delta;
      previous_pdf_ = p_class * s->pdf;
    }
    if (!updateInterior(world_.scene, encounter_, s->transmitted, state_.interior)) return false;
    state_.ray = Ray{offsetOrigin(encounter_.point, s->dir), s->dir};
    return survives();
  }

  bool recordEvent(const Bsdf& bsdf, EventClass c, const BsdfSample& s, float p_class) {
    class_.add(c);
    if (class_.count() == 1 && class_.firstIsDiffuse()) {
      // Irradiance takes the cosine in the place of the BSDF, on the side that the eye sees.
      const float cos_theta = dot(s.dir, bsdf.normal());
      irradiance_throughput_ = vec3(s.delta || s.pdf <= 0.0F ? 0.0F : std::max(cos_theta, 0.0F) / (s.pdf * p_class));
    }
    return class_.count() < world_.options.max_bounces && mayContribute(class_);
  }

  bool survives() {
    if (class_.count() < kRouletteStart) return true;
    // A path that has lost nothing is not ended: glass that keeps all its light stays free of this noise. Radiance over
    // the squared index is what refraction keeps.
    // With other wavelengths aboard, chance must not depend on which of them is the hero.
    const float ior = iorOf(state_.interior.medium(), state_.hero.open ? 0.0F : state_.wavelength_nm);
    const float kept = std::max(maxComponent(glm::abs(throughput_)), maxComponent(glm::abs(irradiance_throughput_)));
    const float q = kept * ior * ior / (eye_ior_ * eye_ior_);
    if (q >= 1.0F) return true;
    if (q <= 0.0F || sampler_.next1D() >= q) return false;
    throughput_ /= q;
    irradiance_throughput_ /= q;
    return true;
  }

  /// What was found by chance.
  void add(const PathClass& path, vec3 radiance, vec3 irradiance) {
    if (!left_.include(path)) record(path, radiance, irradiance);
  }

  void record(const PathClass& path, vec3 radiance, vec3 irradiance) {
    radiance *= state_.hero.weight;
    irradiance *= state_.hero.weight;
    if (!isFinite(radiance) || !isFinite(irradiance)) {
      ++counters_.not_finite;
      return;
    }
    const auto addTo = [&](FilmPlane& plane, vec3 value) {
      if (plane.active()) plane.add(pixel_, value);
    };
    switch (path.layer()) {
      case PathLayer::kEmission:
        addTo(film_.emission, radiance);
        return;
      case PathLayer::kSpecular:
        addTo(film_.specular, radiance);
        if (path.isSpecularCaustic()) addTo(film_.specular_caustic, radiance);
        return;
      case PathLayer::kDirect:
        addTo(film_.direct, radiance);
        break;
      case PathLayer::kCaustic:
        addTo(film_.caustic_from_eye, radiance);
        addTo(film_.irradiance_caustic_from_eye, irradiance);
        break;
      case PathLayer::kIndirect:
        addTo(film_.indirect_from_eye, radiance);
        break;
    }
    addTo(film_.irradiance_from_eye, irradiance);
  }

  const ReferenceWorld& world_;
  const LayerNeeds& needs_;
  const GatheredPhotons* photons_;
  const PhotonPaths& gathered_;
  const PhotonPaths& left_;  ///< gathered here, or made elsewhere
  const Manifold* manifold_;
  Film& film_;
  PathCounters& counters_;
  std::size_t pixel_;
  Sampler sampler_, walk_sampler_;
  PathState state_;
  Encounter encounter_;
  PathClass class_;
  vec3 throughput_{1.0F};             ///< without the weight of its wavelengths
  vec3 irradiance_throughput_{0.0F};  ///< the same from the first diffuse event on, with cosine instead of BSDF there
  vec3 vertex_{0.0F};                 ///< of the last event, or the eye
  bool previous_is_delta_ = true;
  float previous_pdf_ = 0.0F;
  float eye_ior_ = 1.0F;  ///< of the medium around the eye
};

}  // namespace

void PathTracer::tracePath(int x, int y, std::uint32_t sample, Film& film, PathCounters& counters) const {
  const auto pixel = static_cast<std::size_t>(y) * film.width + x;
  Sampler sampler(world_.options.seed, static_cast<std::uint32_t>(pixel), sample);
  const vec2 jitter = sampler.next2D();
  const Sampler walk_sampler(world_.options.seed + kWalkSeedOffset, static_cast<std::uint32_t>(pixel), sample);
  EyePath path(world_, needs_, photons_, gathered_, left_, manifold_, film, counters, pixel, sampler, walk_sampler);
  path.trace(vec2(static_cast<float>(x), static_cast<float>(y)) + jitter);
}

}  // namespace nephroid
