#include "techniques/reference/vcm/eye_path.h"

#include <algorithm>
#include <cmath>

#include "techniques/reference/path_class.h"
#include "techniques/reference/vcm/surface.h"

namespace nephroid {
namespace {

/// Events before Russian roulette begins, as for the paths that make the other layers.
constexpr int kRouletteStart = 6;
/// Makes scramblings of these paths independent of those of the paths that make the other layers.
constexpr std::uint32_t kSeedOffset = 0x56434DU;

class VcmEyePath {
 public:
  VcmEyePath(const VcmTechniques& techniques, const VcmPhotons& photons, const LayerNeeds& needs, Film& film,
             PathCounters& counters, std::size_t pixel, Sampler sampler)
      : techniques_(techniques),
        world_(techniques.world()),
        photons_(photons),
        needs_(needs),
        film_(film),
        counters_(counters),
        pixel_(pixel),
        sampler_(sampler) {}

  void trace(vec2 film_position) {
    state_.ray = world_.camera_model.rayThrough(film_position);
    vertex_ = state_.ray.origin;
    state_.interior = world_.camera_interior;
    eye_ior_ = iorOf(state_.interior.medium(), 0.0F);
    // Panes and holes are no events; the limit on steps keeps two facing panes from holding a path for ever.
    for (int step = 0; step < 4 * world_.options.max_bounces; ++step)
      if (!advance() || !scatter()) return;
  }

 private:
  bool beforeReceiver() const { return class_.count() == 0 || class_.isEyeSpecular(); }
  /// S⁺ lies between here and the receiver: what shines here casts a caustic.
  bool castsCaustic() const { return class_.isSpecularCaustic() || class_.layer() == PathLayer::kCaustic; }
  bool wantsReceiver() const {
    return class_.count() > 0 ? needs_.throughSpecular()
                              : needs_.caustic || needs_.irradiance || needs_.irradiance_caustic;
  }
  bool hasRoomFor(std::uint32_t events) const {
    return class_.count() + static_cast<int>(events) <= world_.options.max_bounces;
  }

  /// To the next surface; adds the light met on the way. @return false if the path ends
  bool advance() {
    const Ray whole = state_.ray;
    world_.walker.advance(state_, sampler_, encounter_, class_.count() == 0);
    counters_.rays += encounter_.rays;
    if (encounter_.overflow) return false;
    const bool lit = castsCaustic() && vertex_is_target_;
    const auto meet = [&](const LightSet::Met& met) { addMet(met); };
    if (lit) world_.lights.visitSpheres(vertex_, whole, encounter_.distance, meet);
    throughput_ *= encounter_.transmittance;
    irradiance_throughput_ *= encounter_.transmittance;
    if (!encounter_.hit) {
      if (lit) world_.lights.visitInfinity(state_.ray.dir, meet);
      return false;
    }
    if (lit) {
      const LightSet::Met met = world_.lights.metSurface(vertex_, encounter_.point, state_.ray.dir);
      if (maxComponent(met.radiance) > 0.0F) addMet(met);
    }
    return maxComponent(throughput_) > 0.0F;
  }

  void addMet(const LightSet::Met& met) {
    const LightRay ray{vertex_, -state_.ray.dir, met.distance, met.normal};
    const float weight = weighMet(half_, met.pdf, techniques_.arrivalDensity(met.source, ray));
    add(class_, throughput_ * met.radiance * weight, irradiance_throughput_ * met.radiance * weight);
  }

  /// @return false if the path ends
  bool scatter() {
    const VcmSurface surface = VcmSurface::ofEncounter(encounter_, world_.options.specular_alpha);
    wo_ = -state_.ray.dir;
    const Bsdf bsdf = surface.bsdfFrom(wo_);
    arrive(surface);
    const bool rough = techniques_.connects() && bsdf.isEvaluable(EventClass::kSpecular);
    if (!beforeReceiver()) {
      if (rough) findLight(surface, bsdf);
      if (rough) connect(surface, bsdf, EventClass::kSpecular, photons_.rough);
    } else {
      if (rough && needs_.throughSpecular()) connect(surface, bsdf, EventClass::kSpecular, photons_.ends);
      if (wantsReceiver() && bsdf.hasDiffuse()) {
        merge(surface, bsdf);
        if (techniques_.connects()) connect(surface, bsdf, EventClass::kDiffuse, photons_.rough);
      }
    }
    return sampleNext(surface, bsdf);
  }

  void arrive(const VcmSurface& surface) {
    const vec3 way = surface.point().position - vertex_;
    const float cos_in = surface.cosine(wo_);
    arrived_ = class_.count() > 0
                   ? half_.arrive(dot(way, way), cos_in)
                   : VcmPartial::startAtEye(techniques_.photons(),
                                            world_.camera_model.importanceAt(surface.point().position), cos_in);
  }

  /// Sums over the photons within a kernel, times its area.
  struct Gathered {
    vec3 radiance{0.0F}, irradiance{0.0F};
    vec3 inner{0.0F};  ///< radiance of half of the kernel
  };
  void gather(const VcmPhoton& photon, const VcmSurface& surface, const Bsdf& bsdf, Gathered& sum) const {
    const vec3 offset = photon.position - surface.point().position, normal = surface.point().normal_geometric;
    const float radius = techniques_.radius();
    if (std::abs(dot(offset, normal)) > kKernelFlatness * radius || !hasRoomFor(photon.events + 1)) return;
    const vec3 wi = -photon.dir;
    const BsdfValue value = bsdf.evaluate(EventClass::kDiffuse, wi, Transport::kRadiance);
    const float reverse = VcmSurface::densityOf(bsdf, EventClass::kDiffuse, value.pdf);
    const float weight = weighMerge(photon.half, arrived_, reverse, techniques_.merging());
    const vec3 incident = photon.flux * weight;
    sum.radiance += incident * value.f;
    if (dot(offset, offset) <= 0.5F * radius * radius) sum.inner += incident * value.f;
    if (isOnEyeSide(surface, wi)) sum.irradiance += incident;
  }
  /// Irradiance counts what arrives on the side that is seen.
  bool isOnEyeSide(const VcmSurface& surface, vec3 wi) const {
    const vec3 normal = surface.point().normal_geometric;
    return dot(wi, normal) * dot(wo_, normal) > 0.0F;
  }

  void merge(const VcmSurface& surface, const Bsdf& bsdf) {
    Gathered sum;
    photons_.grid.visitNear(surface.point().position,
                            [&](const VcmPhoton& photon) { gather(photon, surface, bsdf, sum); });
    const float inverse_area = 1.0F / (kPi * techniques_.radius() * techniques_.radius());
    add(class_.with(EventClass::kDiffuse).with(EventClass::kSpecular), throughput_ * sum.radiance * inverse_area,
        sum.irradiance * inverse_area);
    FilmPlane& plane = class_.count() == 0 ? film_.caustic_bias : film_.specular_caustic_bias;
    if (!plane.active()) return;
    const vec3 bias = 2.0F * throughput_ * inverse_area * (sum.radiance - 2.0F * sum.inner);
    if (isFinite(bias)) plane.add(pixel_, bias);
  }

  /// How the techniques that hand this vertex to the light's half compare with those that do not.
  float sumBehind(const VcmSurface& surface, EventClass c, vec3 wi) const {
    if (c == EventClass::kDiffuse) return arrived_.sumBehind(0.0F, techniques_.merging());
    if (beforeReceiver()) return 0.0F;  // photons end at the receiver
    return arrived_.sumBehind(surface.density(c, wi, wo_), 0.0F);
  }

  void findLight(const VcmSurface& surface, const Bsdf& bsdf) {
    const SurfacePoint& point = surface.point();
    const float u_choice = sampler_.next1D();
    const vec2 u = sampler_.next2D();
    if (!techniques_.isTarget(point) || !hasRoomFor(1)) return;
    const auto light = world_.lights.sample(point.position, u_choice, u);
    if (!light) return;
    const BsdfValue value = bsdf.evaluate(EventClass::kSpecular, light->dir, Transport::kRadiance);
    if (maxComponent(value.f) <= 0.0F) return;
    const vec3 visible = visibility(surface, light->dir, light->distance);
    if (maxComponent(visible) <= 0.0F) return;
    const float pdf = light->delta ? 0.0F : VcmSurface::densityOf(bsdf, EventClass::kSpecular, value.pdf);
    const LightRay ray{point.position, -light->dir, light->distance, light->normal};
    const float weight = weighFound(light->pdf, pdf, techniques_.arrivalDensity(light->source, ray),
                                    surface.cosine(light->dir), sumBehind(surface, EventClass::kSpecular, light->dir));
    const float cos_theta = std::abs(dot(light->dir, bsdf.normal()));
    const vec3 incident = value.f * visible * light->radiance * (cos_theta * weight / light->pdf);
    add(class_.with(EventClass::kSpecular), throughput_ * incident, irradiance_throughput_ * incident);
  }

  /// With one vertex of photons, which stands for all.
  void connect(const VcmSurface& surface, const Bsdf& bsdf, EventClass c, std::span<const VcmLightVertex> vertices) {
    const float u = sampler_.next1D();
    if (vertices.empty()) return;
    const auto count = static_cast<float>(vertices.size());
    const auto at = std::min(static_cast<std::size_t>(static_cast<double>(u) * static_cast<double>(vertices.size())),
                             vertices.size() - 1);
    const VcmLightVertex& end = vertices[at];
    if (!hasRoomFor(end.events + 1)) return;
    const vec3 way = end.point.position - surface.point().position;
    const float squared = dot(way, way);
    if (!(squared > 0.0F)) return;
    const vec3 wi = way / std::sqrt(squared);
    SurfaceMaterial scratch;
    const VcmSurface end_surface(world_.materials.at(end.point, scratch), end.point, end.outer, end.inner,
                                 world_.options.specular_alpha);
    const Bsdf end_bsdf = end_surface.bsdfFrom(end.wo);
    const BsdfValue here = bsdf.evaluate(c, wi, Transport::kRadiance);
    const BsdfValue there = end_bsdf.evaluate(end.event_class, -wi, Transport::kFlux);
    if (maxComponent(here.f) <= 0.0F || maxComponent(there.f) <= 0.0F) return;
    const vec3 visible = visibility(surface, wi, std::sqrt(squared));
    if (maxComponent(visible) <= 0.0F) return;

    const bool end_merges = end.event_class == EventClass::kDiffuse;
    const float weight =
        weighConnection(VcmSurface::densityOf(bsdf, c, here.pdf) * end_surface.cosine(wi) / squared,
                        end.half.sumBehind(end_surface.density(end.event_class, -wi, end.wo),
                                           end_merges ? techniques_.merging() : 0.0F),
                        VcmSurface::densityOf(end_bsdf, end.event_class, there.pdf) * surface.cosine(wi) / squared,
                        sumBehind(surface, c, wi));
    // Cosines as photons have them: see LightPath.
    const float cos_end = end_merges ? end_surface.cosine(wi) * end_bsdf.shadingCosineRatio(end.wo)
                                     : std::abs(dot(wi, end_bsdf.normal()));
    const float cos_here = std::abs(dot(wi, bsdf.normal()));
    const vec3 incident = end.flux * there.f * visible * (count * cos_end * cos_here * weight / squared);
    const bool first = class_.count() == 0;
    add(class_.with(c).with(end.event_class), throughput_ * here.f * incident,
        first ? (isOnEyeSide(surface, wi) ? incident : vec3(0.0F)) : irradiance_throughput_ * here.f * incident);
  }

  vec3 visibility(const VcmSurface& surface, vec3 dir, float distance) {
    const Ray line{offsetOrigin(surface.point(), dir), dir, distance * kShadowEnd};
    return world_.walker.visibility(line, surface.mediumTowards(dir), counters_.rays);
  }

  bool sampleNext(const VcmSurface& surface, const Bsdf& bsdf) {
    const float p_specular = bsdf.specularProbability();
    const bool specular = p_specular > 0.0F && sampler_.next1D() < p_specular;
    const EventClass c = specular ? EventClass::kSpecular : EventClass::kDiffuse;
    const float p_class = specular ? p_specular : 1.0F - p_specular;
    const vec2 u = sampler_.next2D();
    const auto s = bsdf.sample(c, u, sampler_.next1D(), Transport::kRadiance);
    if (!s) return false;
    if (!s->pass && !mayGoOn(c)) return false;
    throughput_ *= s->weight / p_class;
    irradiance_throughput_ *= s->weight / p_class;
    if (!s->pass) recordEvent(surface, bsdf, c, *s, p_class);
    if (!updateInterior(world_.scene, encounter_, s->transmitted, state_.interior)) return false;
    state_.ray = Ray{offsetOrigin(encounter_.point, s->dir), s->dir};
    return survives();
  }
  bool mayGoOn(EventClass c) const {
    if (!hasRoomFor(1)) return false;
    if (!beforeReceiver()) return c == EventClass::kSpecular;
    return c == EventClass::kSpecular ? needs_.throughSpecular() : wantsReceiver() && techniques_.eyeFindsLight();
  }

  void recordEvent(const VcmSurface& surface, const Bsdf& bsdf, EventClass c, const BsdfSample& s, float p_class) {
    const bool before = beforeReceiver(), receives = c == EventClass::kDiffuse;
    if (class_.count() == 0 && receives)
      // Irradiance takes the cosine in the place of the BSDF, on the side that the eye sees.
      irradiance_throughput_ =
          vec3(s.delta || s.pdf <= 0.0F ? 0.0F : std::max(dot(s.dir, bsdf.normal()), 0.0F) / (s.pdf * p_class));
    const float cos_out = surface.cosine(s.dir);
    if (s.delta) {
      half_ = arrived_.scatterDelta(cos_out);
    } else {
      const float reverse = before ? 0.0F : surface.density(c, s.dir, wo_);
      half_ = arrived_.scatter(cos_out, p_class * s.pdf, reverse, receives ? techniques_.merging() : 0.0F);
    }
    if (before && !receives) half_ = half_.forgetLightEnd();
    class_.add(c);
    vertex_ = surface.point().position;
    vertex_is_target_ = techniques_.isTarget(surface.point());
  }

  bool survives() {
    if (class_.count() < kRouletteStart) return true;
    // Radiance over the squared index is what refraction keeps.
    const float ior = iorOf(state_.interior.medium(), 0.0F);
    const float kept = std::max(maxComponent(throughput_), maxComponent(irradiance_throughput_));
    const float q = kept * ior * ior / (eye_ior_ * eye_ior_);
    if (q >= 1.0F) return true;
    if (q <= 0.0F || sampler_.next1D() >= q) return false;
    throughput_ /= q;
    irradiance_throughput_ /= q;
    return true;
  }

  void add(const PathClass& path, vec3 radiance, vec3 irradiance) {
    if (!isFinite(radiance) || !isFinite(irradiance)) {
      ++counters_.not_finite;
      return;
    }
    const auto addTo = [&](FilmPlane& plane, vec3 value) {
      if (plane.active()) plane.add(pixel_, value);
    };
    if (!path.firstIsDiffuse()) {
      addTo(film_.specular, radiance);
      addTo(film_.specular_caustic, radiance);
      return;
    }
    addTo(film_.caustic_from_eye, radiance);
    addTo(film_.irradiance_caustic_from_eye, irradiance);
    addTo(film_.irradiance_from_eye, irradiance);
  }

  const VcmTechniques& techniques_;
  const ReferenceWorld& world_;
  const VcmPhotons& photons_;
  const LayerNeeds& needs_;
  Film& film_;
  PathCounters& counters_;
  std::size_t pixel_;
  Sampler sampler_;
  PathState state_;
  Encounter encounter_;
  PathClass class_;
  vec3 throughput_{1.0F};
  vec3 irradiance_throughput_{0.0F};  ///< the same from the first diffuse event on, with cosine instead of BSDF there
  vec3 vertex_{0.0F};                 ///< of the last event, or the eye
  bool vertex_is_target_ = false;
  vec3 wo_{0.0F};       ///< from the surface that was met last to the vertex before
  VcmPartial half_;     ///< after the last event
  VcmPartial arrived_;  ///< at the surface that was met last
  float eye_ior_ = 1.0F;
};

}  // namespace

void traceVcmEyePath(const VcmTechniques& techniques, const VcmPhotons& photons, const LayerNeeds& needs, int x, int y,
                     std::uint32_t sample, Film& film, PathCounters& counters) {
  const auto pixel = static_cast<std::size_t>(y) * film.width + x;
  Sampler sampler(techniques.world().options.seed + kSeedOffset, static_cast<std::uint32_t>(pixel), sample);
  const vec2 jitter = sampler.next2D();
  VcmEyePath path(techniques, photons, needs, film, counters, pixel, sampler);
  path.trace(vec2(static_cast<float>(x), static_cast<float>(y)) + jitter);
}

}  // namespace nephroid
