#include "techniques/reference/manifold/manifold.h"

#include <algorithm>
#include <cmath>

#include "scene/classify.h"

namespace nephroid {
namespace {

/// Trials before a chain that was found once is no longer looked for. A mean of 1/p is cut by (1 − p)^kMaxTrials; the
/// mean number of trials does not depend on this, for what is hard to find is seldom looked for.
constexpr int kMaxTrials = 1 << 14;
/// Chains whose vertices are nearer to each other than this share of the surface are one. Walks end within kPrecision;
/// what a fold brings nearer is a sliver.
constexpr float kSamePlace = 20.0F * ManifoldWalk::kPrecision;
/// The rarer of mirroring and refraction is tried at least so often: trials, not light, are what it costs.
constexpr float kLeastChoice = 0.03F;

/// Instances that mirror or bend light at some place, however weakly.
std::vector<bool> findGenerators(const ReferenceWorld& world) {
  const SceneData& data = world.scene.scene();
  const std::vector<Classification> classes = classifyMaterials(data, world.options.specular_alpha);
  std::vector<bool> generators;
  for (const Instance& instance : data.instances) {
    const Classification& c = classes[data.meshes[instance.mesh].material];
    generators.push_back(c.is_generator || c.is_weak_generator);
  }
  return generators;
}

/// Probability with which a seed mirrors at the chain's last vertex: by how much light would, within bounds.
float chooseMirroring(const SpecularChain& chain) {
  const int last = chain.count() - 1;
  if (!chain.vertex(last).material->is_solid) return 1.0F;
  return std::clamp(chain.bsdfAt(last).mirroring().probability, kLeastChoice, 1.0F - kLeastChoice);
}

}  // namespace

Manifold::Manifold(const ReferenceWorld& world, const std::vector<bool>& targets,
                   std::span<const std::unique_ptr<Emitter>> emitters)
    : world_(world),
      targets_(targets),
      generators_(world.scene, findGenerators(world)),
      shines_(world.lights.sourceCount(), false),
      medium_of_light_(world.lights.sourceCount(), nullptr) {
  for (const auto& emitter : emitters) {
    shines_[emitter->source()] = true;
    medium_of_light_[emitter->source()] = emitter->interior().medium();
  }
}

bool Manifold::seed(const Task& task, ChainKind& kind) const {
  SpecularChain& chain = task.walk.chain();
  const vec3 way = generators_.sample(task.sampler) - task.origin;
  const float squared = dot(way, way);
  if (!(squared > 0.0F) || !chain.start(way / std::sqrt(squared)) || !chain.advance(task.sampler, task.rays))
    return false;
  kind.count = 1;
  kind.bounces[0] = task.sampler.next1D() < chooseMirroring(chain) ? Bounce::kReflect : Bounce::kTransmit;
  const bool reaches_light = chain.mediumAfter(0, kind.bounces[0]) == task.light_medium;
  // Where the light is beyond the first surface and another one is on the way, either may be the last.
  const bool goes_on = chain.bend(kind.bounces[0]) && chain.advance(task.sampler, task.rays);
  if (!reaches_light) return goes_on && continueSeed(task, kind);
  if (goes_on && task.sampler.next1D() < 0.5F) return continueSeed(task, kind);
  chain.keepFirst();
  return true;
}

bool Manifold::continueSeed(const Task& task, ChainKind& kind) const {
  const SpecularChain& chain = task.walk.chain();
  kind.count = 2;
  const bool mirrors = chain.mediumAfter(1, Bounce::kReflect) == task.light_medium;
  const bool transmits =
      chain.vertex(1).material->is_solid && chain.mediumAfter(1, Bounce::kTransmit) == task.light_medium;
  if (!mirrors && !transmits) return false;
  const float p_mirror = mirrors && transmits ? chooseMirroring(chain) : mirrors ? 1.0F : 0.0F;
  kind.bounces[1] = task.sampler.next1D() < p_mirror ? Bounce::kReflect : Bounce::kTransmit;
  return true;
}

std::optional<Manifold::Solution> Manifold::attempt(const Task& task) const {
  ChainKind kind;
  if (!seed(task, kind)) return std::nullopt;
  const float scale = generators_.scaleOf(task.walk.chain().vertex(0).point.instance);
  if (!task.walk.solve(kind, task.end, scale, task.sampler, task.rays)) return std::nullopt;
  const SpecularChain& chain = task.walk.chain();
  const SurfacePoint& first = chain.vertex(0).point;
  return Solution{kind, first.position, chain.vertex(kind.count - 1).point.position,
                  generators_.scaleOf(first.instance)};
}

int Manifold::countTrials(const Task& task, const Solution& solution) const {
  const float same = kSamePlace * solution.scale;
  for (int trial = 1; trial < kMaxTrials; ++trial) {
    const std::optional<Solution> other = attempt(task);
    if (other && other->kind == solution.kind && length(other->first - solution.first) <= same &&
        length(other->last - solution.last) <= same)
      return trial;
  }
  return kMaxTrials;
}

vec3 Manifold::irradianceOf(const SpecularChain& chain, const ChainKind& kind, const LightPlace& place,
                            std::uint64_t& rays) const {
  const SurfacePoint& last = chain.vertex(kind.count - 1).point;
  if (!targets_[last.instance]) return vec3(0.0F);
  const vec3 to_light = chain.towardsLight(place.position, place.at_infinity);
  const std::optional<float> distance = world_.lights.distanceTo(place, last.position);
  if (!distance) return vec3(0.0F);
  const vec3 emission = world_.lights.emissionOf(place, -to_light);
  const float spread = chain.spread(kind.last(), place.position, place.at_infinity);
  if (maxComponent(emission) <= 0.0F || !(spread > 0.0F)) return vec3(0.0F);
  const Ray line{offsetOrigin(last, to_light), to_light, *distance * kShadowEnd};
  const vec3 visible = world_.walker.visibility(line, chain.mediumAfter(kind.count - 1, kind.last()), rays);
  return emission * visible * chain.transmittance(kind.last()) / spread;
}

std::optional<ManifoldLight> Manifold::estimate(const Encounter& receiver, const InteriorList& interior, vec3 wo,
                                                Sampler& sampler, std::uint64_t& rays) const {
  const float u_choice = sampler.next1D();
  const std::optional<LightPlace> place = world_.lights.samplePlace(u_choice, sampler.next2D());
  if (!place || !shines_[place->source] || generators_.empty()) return std::nullopt;
  const ChainReceiver start(world_.scene, receiver, interior, wo);
  ManifoldWalk walk(world_, start);
  const Task task{receiver.point.position,
                  {place->position, place->at_infinity},
                  medium_of_light_[place->source],
                  walk,
                  sampler,
                  rays};
  const std::optional<Solution> found = attempt(task);
  if (!found) return std::nullopt;
  const vec3 irradiance = irradianceOf(walk.chain(), found->kind, *place, rays);
  if (maxComponent(irradiance) <= 0.0F) return std::nullopt;
  const vec3 wi = walk.chain().dir();
  return ManifoldLight{wi, irradiance * static_cast<float>(countTrials(task, *found))};
}

}  // namespace nephroid
