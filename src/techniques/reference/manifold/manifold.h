// Manifold next-event estimation ([hanika-2015], [zeltner-2020]): caustics over one or two smooth interfaces, found
// from the receiver.
//
// At the first D vertex of a path from the eye, x0, a place on a light is drawn and joined to x0 over mirrors and
// glass: a seed, a random place on a generator, is walked to the nearest chain that obeys the laws of optics (walk.h).
// There may be many such chains, and nobody knows how likely a seed leads to which. As [zeltner-2020] (section 4.3),
// the inverse of that probability is estimated by drawing seeds until one leads to the same chain again: the number of
// trials has the mean 1/p. Each chain is met with probability p and then counts for 1/p on average: no bias, and
// 1 + (number of chains) walks a vertex on average, however hard they are to find.
// Limits: paths as share.h says. A chain that no seed in kMaxTrials finds again is cut off there, and is missing in
// part if p is below about 1/kMaxTrials; two chains nearer to each other than kSamePlace of their surface count as one.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "techniques/reference/manifold/generators.h"
#include "techniques/reference/manifold/walk.h"
#include "techniques/reference/world.h"
#include "trace/emission.h"

namespace nephroid {

/// Light that arrives at a receiver along a chain.
struct ManifoldLight {
  vec3 wi;          ///< unit, away from the receiver, to the first vertex
  vec3 irradiance;  ///< on the true surface of the receiver, W/m²; an estimate, seldom the same twice
};

/// Immutable, safe from any thread.
class Manifold {
 public:
  /// @param targets   by instance: what photons are aimed at; chains end there, on the light's side, as theirs do
  /// @param emitters  of the lights whose photons reach them
  Manifold(const ReferenceWorld& world, const std::vector<bool>& targets,
           std::span<const std::unique_ptr<Emitter>> emitters);

  /// Light over one or two interfaces, estimated.
  /// @param interior  of the path that came to the receiver  @param wo  as for ChainReceiver
  std::optional<ManifoldLight> estimate(const Encounter& receiver, const InteriorList& interior, vec3 wo,
                                        Sampler& sampler, std::uint64_t& rays) const;

 private:
  /// What is joined: a receiver and a place on a light.
  struct Task {
    vec3 origin;  ///< of the receiver, m
    ChainEnd end;
    const Material* light_medium;  ///< in which the light shines; null: vacuum
    ManifoldWalk& walk;
    Sampler& sampler;
    std::uint64_t& rays;
  };
  /// One chain, told from others by where its vertices are.
  struct Solution {
    ChainKind kind;
    vec3 first;
    vec3 last;
    float scale;  ///< of the first vertex's instance, m
  };
  bool seed(const Task& task, ChainKind& kind) const;
  bool continueSeed(const Task& task, ChainKind& kind) const;
  std::optional<Solution> attempt(const Task& task) const;
  int countTrials(const Task& task, const Solution& solution) const;
  vec3 irradianceOf(const SpecularChain& chain, const ChainKind& kind, const LightPlace& place,
                    std::uint64_t& rays) const;

  const ReferenceWorld& world_;
  std::vector<bool> targets_;
  GeneratorSurfaces generators_;
  std::vector<bool> shines_;                      ///< by source: photons of it reach the targets
  std::vector<const Material*> medium_of_light_;  ///< by source
};

}  // namespace nephroid
