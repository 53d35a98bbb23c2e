#include "techniques/reference/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "techniques/reference/guided_bsdf.h"

namespace nephroid {
namespace {

/// Events before Russian roulette by what is left begins: glass objects need a handful to be seen through.
constexpr int kRouletteStart = 4;

/// Walks on the specular manifold draw their numbers from a seed of their own: how many they take is left to chance.
constexpr std::uint32_t kWalkSeedOffset = 0x6D6E6565U;

/// Where clear glass both mirrors and transmits, both ways are followed if the lesser of them keeps this share of what
/// the path began with. So a path has at most some dozen strands at once; a mirror image in glass (0.04) is followed
/// from outside and, once more, from within, but not the image of an image.
constexpr float kLeastShare = 1.0F / 64.0F;
/// The lesser way, if it is less than this, is followed only as often as it pays.
constexpr float kLesserShare = 1.0F / 4.0F;
/// What is transmitted then draws its numbers from another seed: if both ways took the same, their errors would add up.
constexpr std::uint32_t kSplitSeedOffset = 0x73747261U;

/// Ways on from the first diffuse surface that a path from the eye meets, unless light samples alone tell of all that
/// is asked for. The light that comes straight from lamps has little noise there, so following one would spend much on
/// finding the place again.
constexpr std::uint32_t kDiffuseStrands = 4;
/// They draw their numbers from one sequence, as neighbours in it, so that they are spread evenly.
constexpr std::uint32_t kDiffuseSeedOffset = 0x64696666U;
/// Where nothing beyond the first diffuse surface is asked for, shadow rays from there are what the path is made of,
/// and cost less than a path of their own each.
constexpr std::uint32_t kLightSamples = 4;
constexpr std::uint32_t kLightSeedOffset = 0x6C616D70U;
/// Lights that paths meet by chance this much more seldom than light samples find them count by those alone: with both,
/// chance would bring a ten-thousandth of what such a light sends, by the power heuristic.
constexpr float kIdleChance = 0.01F;
/// Where directions were learned, half of them are drawn by those, spread evenly on their own.
constexpr std::uint32_t kGuidedStrands = kDiffuseStrands / 2;
constexpr std::uint32_t kGuidedSeedOffset = 0x67756964U;

/// Of what is seen first.
bool drawsSeveralLightSamples(const LayerNeeds& needs) { return needs.direct && !needs.beyondDiffuse(); }

float powerHeuristic(float pdf, float other) {
  if (!std::isfinite(pdf)) return 1.0F;
  const float a = pdf * pdf, b = other * other;
  return a > 0.0F ? a / (a + b) : 0.0F;
}

/// A path as far as it has come. It begins as one strand; where clear glass both mirrors and transmits it becomes two,
/// and some where it first meets a diffuse surface.
struct Strand {
  Sampler sampler;
  PathState state;
  PathClass events;
  vec3 throughput{1.0F};             ///< without the weight of its wavelengths
  vec3 irradiance_throughput{0.0F};  ///< the same from the first diffuse event on, with cosine instead of BSDF there
  float split_share = 1.0F;          ///< of the path, after all splits
  float rate = 1.0F;                 ///< probability with which it was followed this far (see Continuation)
  float rarity = 1.0F;               ///< density of a guided way by the BSDF alone, over that with which it was drawn
  vec3 vertex{0.0F};                 ///< of the last event, or the eye
  bool previous_is_delta = true;
  float previous_pdf = 0.0F;
  float previous_light_samples = 1.0F;  ///< that were drawn there for each way on
  bool by_lesser_way = false;           ///< came by one at clear glass
  std::int64_t lesson = -1;             ///< that tells of the strand; −1: none
  float lesson_scale = 0.0F;            ///< from radiance in the pixel to what came by the way of the lesson
};

/// One path on its way from the eye, with all of its strands.
class EyePath {
 public:
  EyePath(const ReferenceWorld& world, const LayerNeeds& needs, const GatheredPhotons* photons,
          const PhotonPaths& gathered, const PhotonPaths& left, const Manifold* manifold,
          const Continuation& continuation, const DirectionGuide* guide, Film& film, PathCounters& counters, int x,
          int y, std::uint32_t sample)
      : world_(world),
        needs_(needs),
        photons_(photons),
        gathered_(gathered),
        left_(left),
        manifold_(manifold),
        continuation_(continuation),
        guide_(guide),
        film_(film),
        counters_(counters),
        x_(x),
        y_(y),
        pixel_(static_cast<std::size_t>(y) * film.width + x),
        sample_(sample),
        walk_sampler_(makeSampler(kWalkSeedOffset)),
        strand_{makeSampler(0)} {}

  void trace() {
    const vec2 pixel_corner(static_cast<float>(x_), static_cast<float>(y_));
    strand_.state.ray = world_.camera_model.rayThrough(pixel_corner + strand_.sampler.next2D());
    strand_.vertex = strand_.state.ray.origin;
    strand_.state.interior = world_.camera_interior;
    eye_ior_ = iorOf(strand_.state.interior.medium(), 0.0F);
    traceStrand();
    while (!waiting_.empty()) {
      strand_ = waiting_.back();
      waiting_.pop_back();
      traceStrand();
    }
  }

 private:
  Sampler makeSampler(std::uint32_t seed_offset) const {
    return {world_.options.seed + seed_offset, static_cast<std::uint32_t>(pixel_), sample_};
  }

  void traceStrand() {
    // Panes and holes are no events; the limit on steps keeps two facing panes from holding a path for ever.
    for (int step = 0; step < 4 * world_.options.max_bounces; ++step)
      if (!advance() || !scatter()) return;
  }

  /// To the next surface; adds the light met on the way. @return false if the path ends
  bool advance() {
    const Ray whole = strand_.state.ray;
    world_.walker.advance(strand_.state, strand_.sampler, encounter_, strand_.events.count() == 0);
    countRays(encounter_.rays);
    if (DirectionLesson* lesson = lessonOfStrand(); lesson && lesson->distance == 0.0F)
      lesson->distance = encounter_.distance;
    if (encounter_.overflow) return false;
    world_.lights.visitSpheres(strand_.vertex, whole, encounter_.distance,
                               [&](const LightSet::Met& met) { addMet(met); });
    strand_.throughput *= encounter_.transmittance;
    strand_.irradiance_throughput *= encounter_.transmittance;
    if (!encounter_.hit) {
      world_.lights.visitInfinity(strand_.state.ray.dir, [&](const LightSet::Met& met) { addMet(met); });
      return false;
    }
    const LightSet::Met met = world_.lights.metSurface(strand_.vertex, encounter_.point, strand_.state.ray.dir);
    if (maxComponent(met.radiance) > 0.0F) addMet(met);
    return maxComponent(glm::abs(strand_.throughput)) > 0.0F;
  }

  void countRays(std::uint64_t rays) {
    counters_.rays += rays;
    if (DirectionLesson* lesson = lessonOfStrand()) lesson->rays += static_cast<float>(rays);
    if (!counters_.parts) return;
    const double always = static_cast<double>(rays) / strand_.rate;
    counters_.parts->rays[PathPart::of(strand_.events)] += always;
    if (strand_.by_lesser_way) counters_.parts->lesser_rays += always;
  }

  void addMet(const LightSet::Met& met) {
    const float weight = strand_.previous_is_delta
                             ? 1.0F
                             : powerHeuristic(strand_.previous_pdf, strand_.previous_light_samples * met.pdf);
    add(strand_.events, strand_.throughput * met.radiance * weight,
        strand_.irradiance_throughput * met.radiance * weight);
  }

  /// @return false if the path ends
  bool scatter() {
    const vec3 wo = -strand_.state.ray.dir;
    drawWavelength(strand_.state, encounter_, world_.options.spectral, strand_.sampler);
    const float ior_from = iorOf(encounter_.boundary.from, strand_.state.wavelength_nm);
    const float ior_to = iorOf(encounter_.boundary.to, strand_.state.wavelength_nm);
    const Bsdf bsdf(*encounter_.material, encounter_.point, wo, ior_from, ior_to, world_.options.specular_alpha);
    if (!bsdf.isClear()) settleWavelength(strand_.state, encounter_);
    lobe_ = guide_ && bsdf.hasDiffuse() && strand_.events.diffuseCount() == 0 ? guide_->at(encounter_.point.position)
                                                                              : nullptr;
    planLight(bsdf);
    for (const EventClass c : {EventClass::kSpecular, EventClass::kDiffuse})
      if (bsdf.isEvaluable(c) && isWanted(strand_.events.with(c))) connectToLights(bsdf, c);
    if (photons_ && bsdf.hasDiffuse()) gather(bsdf);
    if (manifold_ && bsdf.hasDiffuse() && wantsWalk()) walkToLight(bsdf);
    return sampleNext(bsdf);
  }

  void gather(const Bsdf& bsdf) {
    const bool is_first = strand_.events.count() == 0, behind = strand_.events.isEyeSpecular();
    const bool caustic = is_first ? gathered_.caustic : gathered_.specular_caustic && behind;
    const bool indirect = is_first ? gathered_.indirect : gathered_.specular_indirect && behind;
    if (caustic && counters_.gather_places) counters_.gather_places->push_back(encounter_.point.position);
    if (caustic) gatherCaustic(bsdf);
    if (indirect) gatherIndirect(bsdf);
  }

  /// What kernels about a point say of it.
  struct Gathered {
    vec3 radiance{0.0F};
    vec3 irradiance{0.0F};  ///< where it is seen directly
    vec3 by_half{0.0F};     ///< radiance, if kernels had half of their areas
  };
  /// @param asks_for_half  is `by_half` wanted? It is 0 else
  Gathered gatherFrom(const KernelMap& map, const Bsdf& bsdf, bool asks_for_half) {
    const bool asks_for_irradiance = strand_.events.count() == 0 && needs_.anyIrradiance();
    if (const auto constant = bsdf.constantDiffuse(); constant && !asks_for_irradiance)
      return gatherByConstant(map, bsdf, *constant, asks_for_half);
    const SurfacePoint& point = encounter_.point;
    Gathered found;
    map.visitKernels(point.position, point.normal_geometric, [&](const KernelPhoton& photon, float squared_radius) {
      ++counters_.kernels;
      const vec3 wi = -photon.dir;
      const vec3 reflected = photon.flux * bsdf.evaluate(EventClass::kDiffuse, wi, Transport::kRadiance).f;
      found.radiance += photon.weightAt(squared_radius) * reflected;
      if (asks_for_half) found.by_half += photon.halfWeightAt(squared_radius) * reflected;
      // As for light that is connected to the camera: on the side that the eye sees.
      if (asks_for_irradiance &&
          dot(wi, point.normal_geometric) * dot(strand_.state.ray.dir, point.normal_geometric) < 0.0F)
        found.irradiance += photon.weightAt(squared_radius) * photon.flux;
    });
    return found;
  }
  /// The same where nothing but flux differs from photon to photon.
  Gathered gatherByConstant(const KernelMap& map, const Bsdf& bsdf, vec3 constant, bool asks_for_half) {
    const SurfacePoint& point = encounter_.point;
    vec3 incident(0.0F), incident_by_half(0.0F);  // W/m²
    std::uint64_t kernels = 0;
    map.visitKernels(point.position, point.normal_geometric, [&](const KernelPhoton& photon, float squared_radius) {
      ++kernels;
      if (!bsdf.reflectsFrom(-photon.dir)) return;
      incident += photon.weightAt(squared_radius) * photon.flux;
      if (asks_for_half) incident_by_half += photon.halfWeightAt(squared_radius) * photon.flux;
    });
    counters_.kernels += kernels;
    return {.radiance = constant * incident, .by_half = constant * incident_by_half};
  }

  void gatherCaustic(const Bsdf& bsdf) {
    const KernelMap& map = photons_->caustics();
    if (map.empty()) return;
    FilmPlane& plane = strand_.events.count() == 0 ? film_.caustic_bias : film_.specular_caustic_bias;
    const Gathered found = gatherFrom(map, bsdf, plane.active());
    record(strand_.events.with(EventClass::kDiffuse).with(EventClass::kSpecular), strand_.throughput * found.radiance,
           found.irradiance);
    if (!plane.active()) return;
    // Where light varies smoothly a kernel errs in proportion to its area at most (Knaus & Zwicker 2011), so by twice
    // what it says more than one of half its area.
    const vec3 bias = 2.0F * strand_.state.hero.weight * strand_.throughput * (found.radiance - found.by_half);
    if (isFinite(bias)) plane.add(pixel_, bias);
  }

  void gatherIndirect(const Bsdf& bsdf) {
    const KernelMap& map = photons_->indirect();
    if (map.empty()) return;
    const PathClass path =
        strand_.events.with(EventClass::kDiffuse).with(EventClass::kDiffuse).with(EventClass::kSpecular);  // for one
    const Gathered found = gatherFrom(map, bsdf, false);
    record(path, strand_.throughput * found.radiance, found.irradiance);
  }

  bool wantsWalk() const {
    if (strand_.events.isEyeSpecular()) return needs_.throughSpecular();
    return strand_.events.count() == 0 && (needs_.caustic || needs_.irradiance || needs_.irradiance_caustic);
  }
  void walkToLight(const Bsdf& bsdf) {
    const auto light =
        manifold_->estimate(encounter_, strand_.state.interior, -strand_.state.ray.dir, walk_sampler_, counters_.rays);
    if (!light) return;
    const vec3 incident = light->irradiance * bsdf.shadingCosineRatio(light->wi);
    const vec3 radiance = incident * bsdf.evaluate(EventClass::kDiffuse, light->wi, Transport::kRadiance).f;
    const vec3 normal = encounter_.point.normal_geometric;
    const bool seen_side = dot(light->wi, normal) * dot(strand_.state.ray.dir, normal) < 0.0F;
    record(strand_.events.with(EventClass::kDiffuse).with(EventClass::kSpecular), strand_.throughput * radiance,
           strand_.events.count() == 0 && seen_side ? incident : vec3(0.0F));
  }

  /// Can a path that begins with these events still end in a layer that was asked for?
  bool mayContribute(const PathClass& c) const {
    if (c.count() == 0) return true;
    if (!c.firstIsDiffuse()) return needs_.specular || (needs_.throughSpecular() && c.mayBecomeSpecularCaustic());
    // Light that is met by chance counts in part for what was sampled towards lights, so it has to be looked for.
    if (c.count() == 1 && needs_.direct) return true;
    return leadsBeyondDirect(c);
  }
  /// To light that has more than one event. @param c  events, of which the first is diffuse
  bool leadsBeyondDirect(const PathClass& c) const {
    const bool caustic = !left_.caustic && (needs_.caustic || needs_.irradiance_caustic);
    return needs_.beyondDiffuse() || (caustic && c.mayBecomeCaustic());
  }
  bool isWanted(const PathClass& c) const {
    if (left_.include(c)) return false;
    if (c.firstIsDiffuse() && (needs_.irradiance || needs_.irradiance_caustic)) return true;
    return mayContribute(c) || c.layer() == PathLayer::kDirect;
  }

  /// How light is looked for at the surface met last.
  void planLight(const Bsdf& bsdf) {
    light_samples_ = diffuse_strands_ = 1;
    chance_is_idle_ = asks_penumbrae_ = false;
    if (strand_.events.count() > 0) return;
    constexpr float kMostOfLambert = 1.0F / kPi;  // 1/sr
    const float by_samples = world_.lights.leastDensity(encounter_.point.position);
    const bool lights_are_small = bsdf.hasConstantDiffuse() && kMostOfLambert <= kIdleChance * by_samples;
    chance_is_idle_ =
        (lights_are_small || !needs_.direct) && !leadsBeyondDirect(strand_.events.with(EventClass::kDiffuse));
    diffuse_strands_ = chance_is_idle_ ? 1 : kDiffuseStrands;
    const bool is_without_size = world_.lights.count() == 1 && by_samples == kInfinity;
    if (!drawsSeveralLightSamples(needs_) || is_without_size) return;
    asks_penumbrae_ = lights_are_small && counters_.penumbrae && world_.lights.count() == 1;
    if (!asks_penumbrae_ || counters_.penumbrae->mayBeAt(x_, y_, sample_)) light_samples_ = kLightSamples;
  }
  /// What the multi-sample model of multiple importance sampling needs to know (Veach 1997, section 9.2).
  float lightSamplesPerWay(EventClass c) const {
    return static_cast<float>(light_samples_) /
           (c == EventClass::kDiffuse ? static_cast<float>(diffuse_strands_) : 1.0F);
  }
  void connectToLights(const Bsdf& bsdf, EventClass c) {
    if (light_samples_ == 1) {
      const bool seen = connectToLight(bsdf, c, strand_.sampler);
      return noteLight(c, seen ? 1 : 0);
    }
    std::uint32_t seen = 0;
    for (std::uint32_t i = 0; i < light_samples_; ++i) {
      Sampler sampler(world_.options.seed + kLightSeedOffset, static_cast<std::uint32_t>(pixel_),
                      sample_ * kLightSamples + i);
      if (connectToLight(bsdf, c, sampler)) ++seen;
    }
    noteLight(c, seen);
  }
  void noteLight(EventClass c, std::uint32_t seen) {
    if (asks_penumbrae_ && c == EventClass::kDiffuse) counters_.penumbrae->note(x_, y_, seen, light_samples_);
  }
  /// By one of several light samples. @return whether it met nothing
  bool connectToLight(const Bsdf& bsdf, EventClass c, Sampler& sampler) {
    const float u_choice = sampler.next1D();
    const auto light = world_.lights.sample(encounter_.point.position, u_choice, sampler.next2D());
    if (!light) return false;
    const BsdfValue value = bsdf.evaluate(c, light->dir, Transport::kRadiance);
    const float cos_theta = std::abs(dot(light->dir, bsdf.normal()));
    if (maxComponent(value.f) <= 0.0F) return false;
    const Ray shadow{offsetOrigin(encounter_.point, light->dir), light->dir, light->distance * kShadowEnd};
    std::uint64_t rays = 0;
    const vec3 visible = world_.walker.visibility(shadow, mediumTowards(light->dir), rays);
    countRays(rays);
    if (maxComponent(visible) <= 0.0F) return false;
    const float p_class = c == EventClass::kSpecular ? bsdf.specularProbability() : 1.0F - bsdf.specularProbability();
    const float pdf = light->delta || c == EventClass::kSpecular ? value.pdf : guided(bsdf).pdf(light->dir, value.pdf);
    const bool alone = light->delta || (chance_is_idle_ && c == EventClass::kDiffuse);
    const float weight = alone ? 1.0F : powerHeuristic(lightSamplesPerWay(c) * light->pdf, p_class * pdf);
    const float light_pdf = light->pdf * static_cast<float>(light_samples_);
    const vec3 incident = visible * light->radiance * (cos_theta * weight / light_pdf);
    const PathClass path = strand_.events.with(c);
    const vec3 irradiance = path.count() == 1 ? incident : strand_.irradiance_throughput * value.f * incident;
    add(path, strand_.throughput * value.f * incident, irradiance);
    return true;
  }

  /// The medium on the side of the surface that `dir` leaves to.
  const Material* mediumTowards(vec3 dir) const {
    const bool same_side = (dot(dir, encounter_.point.normal_geometric) > 0.0F) ==
                           (dot(strand_.state.ray.dir, encounter_.point.normal_geometric) < 0.0F);
    return same_side ? encounter_.boundary.from : encounter_.boundary.to;
  }

  bool sampleNext(const Bsdf& bsdf) {
    if (splits(bsdf)) return followBoth(bsdf);
    const float p_specular = bsdf.specularProbability();
    const bool specular = p_specular > 0.0F && strand_.sampler.next1D() < p_specular;
    if (!specular && chance_is_idle_) return false;
    if (!specular && diffuse_strands_ > 1) return followDiffuseStrands(bsdf, 1.0F - p_specular);
    return specular ? followSpecular(bsdf, p_specular) : followDiffuse(bsdf, 1.0F - p_specular, 1.0F, WayBy::kChance);
  }
  bool followSpecular(const Bsdf& bsdf, float p_class) {
    const vec2 u = strand_.sampler.next2D();
    const auto s = bsdf.sample(EventClass::kSpecular, u, strand_.sampler.next1D(), Transport::kRadiance);
    return s && follow(bsdf, EventClass::kSpecular, *s, p_class, true);
  }
  /// @param share  of the path that the strand is
  bool followDiffuse(const Bsdf& bsdf, float p_class, float share, WayBy by) {
    const float q = continuation_.into(strand_.events.with(EventClass::kDiffuse));
    if (q < 1.0F && strand_.sampler.next1D() >= q) return false;
    share /= q;
    strand_.rate *= q;
    const vec2 u = strand_.sampler.next2D();
    auto way = guided(bsdf).sample(u, strand_.sampler.next1D(), by);
    if (!way) return false;
    if (counters_.lessons && strand_.events.diffuseCount() == 0 && !way->sample.delta)
      beginLesson(*way, p_class / share);
    if (lobe_ && way->pdf_bsdf > 0.0F) strand_.rarity *= way->pdf_bsdf / way->sample.pdf;
    way->sample.weight *= share;
    strand_.split_share *= share;
    return follow(bsdf, EventClass::kDiffuse, way->sample, p_class, true);
  }
  /// Of the surface met last.
  GuidedBsdf guided(const Bsdf& bsdf) const { return {bsdf, lobe_, encounter_.point.position}; }

  /// @param odds  probability of the class over the strand's share
  void beginLesson(const GuidedBsdf::Way& way, float odds) {
    const float carried = luminance(strand_.throughput * strand_.state.hero.weight);
    if (!(carried > 0.0F)) return;
    strand_.lesson = static_cast<std::int64_t>(counters_.lessons->size());
    strand_.lesson_scale = odds * way.sample.pdf / carried;
    counters_.lessons->push_back({.position = encounter_.point.position,
                                  .dir = way.sample.dir,
                                  .pdf = way.sample.pdf,
                                  .pdf_bsdf = way.pdf_bsdf});
  }
  DirectionLesson* lessonOfStrand() const {
    return strand_.lesson >= 0 ? &(*counters_.lessons)[static_cast<std::size_t>(strand_.lesson)] : nullptr;
  }

  /// Where a diffuse surface is seen, the path becomes several strands, all of which wait. @return false
  bool followDiffuseStrands(const Bsdf& bsdf, float p_class) {
    const Strand before = strand_;
    for (std::uint32_t i = 0; i < kDiffuseStrands; ++i) {
      strand_ = before;
      const bool by_guide = lobe_ && i < kGuidedStrands;
      const std::uint32_t first = lobe_ && !by_guide ? kGuidedStrands : 0,
                          strands = lobe_ ? kGuidedStrands : kDiffuseStrands;
      const std::uint32_t seed_offset = by_guide ? kGuidedSeedOffset : kDiffuseSeedOffset;
      strand_.sampler =
          Sampler(world_.options.seed + seed_offset, static_cast<std::uint32_t>(pixel_), sample_ * strands + i - first);
      if (followDiffuse(bsdf, p_class, 1.0F / kDiffuseStrands, by_guide ? WayBy::kGuide : WayBy::kBsdf))
        waiting_.push_back(strand_);
    }
    return false;
  }

  /// Does clear glass send the path both ways? Where one of them brings next to nothing chance decides.
  bool splits(const Bsdf& bsdf) const {
    if (!bsdf.isClear()) return false;
    const float mirrored = mirroredShare(bsdf);
    return share() * std::min(mirrored, 1.0F - mirrored) >= kLeastShare;
  }
  /// Several wavelengths aboard must agree on whether they are split: they go by the index at the d line.
  float mirroredShare(const Bsdf& bsdf) const {
    if (!strand_.state.hero.open) return bsdf.mirroring().probability;
    const Interface& boundary = encounter_.boundary;
    const Bsdf at_d_line(*encounter_.material, encounter_.point, -strand_.state.ray.dir, iorOf(boundary.from, 0.0F),
                         iorOf(boundary.to, 0.0F), world_.options.specular_alpha);
    return at_d_line.mirroring().probability;
  }

  /// The path goes on as what is transmitted, and what is mirrored waits.
  /// @return false if nothing is transmitted
  bool followBoth(const Bsdf& bsdf) {
    const float mirrored = bsdf.mirroring().probability, mirrored_share = mirroredShare(bsdf);
    const bool lesser = continuation_.lesser_way >= 1.0F || strand_.sampler.next1D() < continuation_.lesser_way;
    const Strand before = strand_;
    if (mirrored > 0.0F && followWay(bsdf, 0.0F, mirrored_share, lesser)) waiting_.push_back(strand_);
    if (mirrored >= 1.0F) return false;
    strand_ = before;
    strand_.sampler = makeSampler(++split_count_ * kSplitSeedOffset);
    return followWay(bsdf, kOneMinusEpsilon, 1.0F - mirrored_share, lesser);
  }
  /// @param u_lobe  the number by which chance would have taken this way  @param share  of this way
  /// @param lesser  are lesser ways followed?
  bool followWay(const Bsdf& bsdf, float u_lobe, float share, bool lesser) {
    const bool is_lesser = share < kLesserShare;
    if (is_lesser && !lesser) return false;
    auto s = bsdf.sample(EventClass::kSpecular, vec2(0.0F), u_lobe, Transport::kRadiance);
    if (!s) return false;
    const float q = is_lesser ? continuation_.lesser_way : 1.0F;
    s->weight *= s->probability / q;
    strand_.split_share *= share / q;
    strand_.rate *= q;
    strand_.by_lesser_way |= is_lesser;
    return follow(bsdf, EventClass::kSpecular, *s, 1.0F, false);
  }

  /// @param by_chance  else all ways are followed  @return false if the strand ends
  bool follow(const Bsdf& bsdf, EventClass c, const BsdfSample& s, float p_class, bool by_chance) {
    followWavelengths(strand_.state, encounter_, -strand_.state.ray.dir, world_.options.specular_alpha, s.transmitted,
                      by_chance);
    strand_.throughput *= s.weight / p_class;
    strand_.irradiance_throughput *= s.weight / p_class;
    if (!s.pass) {
      strand_.previous_light_samples = lightSamplesPerWay(c);
      if (!recordEvent(bsdf, c, s, p_class)) return false;
      strand_.vertex = encounter_.point.position;
      strand_.previous_is_delta = s.delta;
      strand_.previous_pdf = p_class * s.pdf;
    }
    if (!updateInterior(world_.scene, encounter_, s.transmitted, strand_.state.interior)) return false;
    strand_.state.ray = Ray{offsetOrigin(encounter_.point, s.dir), s.dir};
    return survives();
  }

  bool recordEvent(const Bsdf& bsdf, EventClass c, const BsdfSample& s, float p_class) {
    strand_.events.add(c);
    if (strand_.events.count() == 1 && strand_.events.firstIsDiffuse()) {
      // Irradiance takes the cosine in the place of the BSDF, on the side that the eye sees.
      const float cos_theta = dot(s.dir, bsdf.normal());
      strand_.irradiance_throughput =
          vec3(s.delta || s.pdf <= 0.0F ? 0.0F : strand_.split_share * std::max(cos_theta, 0.0F) / (s.pdf * p_class));
    }
    return strand_.events.count() < world_.options.max_bounces && mayContribute(strand_.events);
  }

  /// Of what a path could bring when it began, the strand's share. Radiance over the squared index is what refraction
  /// keeps; that a guide sent many this way is no loss.
  float share() const {
    // With other wavelengths aboard, chance must not depend on which of them is the hero.
    const HeroWavelengths& hero = strand_.state.hero;
    const float ior = iorOf(strand_.state.interior.medium(), hero.open ? 0.0F : strand_.state.wavelength_nm);
    const float kept =
        std::max(maxComponent(glm::abs(strand_.throughput)), maxComponent(glm::abs(strand_.irradiance_throughput)));
    return kept / strand_.rarity * (hero.open ? hero.meanOverHero() : 1.0F) * ior * ior / (eye_ior_ * eye_ior_);
  }

  bool survives() {
    if (strand_.events.count() < kRouletteStart) return true;
    // A strand that has lost nothing but what its siblings took is not ended: glass that keeps all its light stays free
    // of this noise.
    const float q = share() / strand_.split_share;
    if (q >= 1.0F) return true;
    if (q <= 0.0F || strand_.sampler.next1D() >= q) return false;
    strand_.throughput /= q;
    strand_.irradiance_throughput /= q;
    return true;
  }

  /// What was found by chance.
  void add(const PathClass& path, vec3 radiance, vec3 irradiance) {
    if (!left_.include(path)) record(path, radiance, irradiance);
  }

  void record(const PathClass& path, vec3 radiance, vec3 irradiance) {
    radiance *= strand_.state.hero.weight;
    irradiance *= strand_.state.hero.weight;
    if (!isFinite(radiance) || !isFinite(irradiance)) {
      ++counters_.not_finite;
      return;
    }
    if (counters_.parts) {
      // Followed always it would weigh less, but be there as often again.
      const double found = dot(radiance, radiance), always = strand_.rate * found;
      counters_.parts->squares[PathPart::of(strand_.events)] += always;
      if (strand_.by_lesser_way) counters_.parts->lesser_squares += always;
      counters_.parts->excess += found - always;
    }
    if (DirectionLesson* lesson = lessonOfStrand()) lesson->value += strand_.lesson_scale * luminance(radiance);
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
  const Continuation& continuation_;
  const DirectionGuide* guide_;
  Film& film_;
  PathCounters& counters_;
  int x_, y_;
  std::size_t pixel_;
  std::uint32_t sample_;
  Sampler walk_sampler_;
  Strand strand_;                ///< on its way
  std::vector<Strand> waiting_;  ///< where the path became several
  std::uint32_t split_count_ = 0;
  Encounter encounter_;
  const DirectionLobe* lobe_ = nullptr;  ///< of the surface met last, if ways on from there are guided
  // Of the surface met last:
  std::uint32_t light_samples_ = 1;    ///< for each class
  std::uint32_t diffuse_strands_ = 1;  ///< ways on if the next event is diffuse
  bool chance_is_idle_ = false;        ///< diffuse ways on would bring nothing that light samples do not
  bool asks_penumbrae_ = false;        ///< how many light samples there are depends on what its tile showed
  float eye_ior_ = 1.0F;               ///< of the medium around the eye
};

}  // namespace

void PathTracer::tracePath(int x, int y, std::uint32_t sample, Film& film, PathCounters& counters,
                           const Continuation& continuation) const {
  EyePath path(world_, needs_, photons_, gathered_, left_, manifold_, continuation, guide_, film, counters, x, y,
               sample);
  path.trace();
}

bool PathTracer::mayDrawSeveralLightSamples() const { return drawsSeveralLightSamples(needs_); }

}  // namespace nephroid
