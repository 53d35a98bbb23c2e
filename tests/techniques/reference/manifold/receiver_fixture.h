// A point of a floor, ready for chains to start from.
#pragma once

#include <gtest/gtest.h>

#include "support/tiny_scenes.h"
#include "techniques/reference/manifold/walk.h"

namespace nephroid::test {

/// The world of a scene, and where a ray from `eye` to `target` first meets it.
struct ReceiverFixture {
  ReferenceWorld world;
  PathState state;
  Encounter encounter;
  Sampler sampler{1, 2, 3};
  std::uint64_t rays = 0;

  ReceiverFixture(const SceneData& scene, vec3 eye, vec3 target)
      : world(scene, makeCamera("test", eye, target, 1.0F), 8, 8, ReferenceOptions{}) {
    state.ray = Ray{eye, normalize(target - eye)};
    world.walker.advance(state, sampler, encounter);
    EXPECT_TRUE(encounter.hit);
  }
  ChainReceiver receiver() const { return {world.scene, encounter, state.interior, -state.ray.dir}; }

  /// Starts a chain and takes it to its last vertex. @return false if it does not get there
  bool follow(SpecularChain& chain, vec3 dir, const ChainKind& kind) {
    if (!chain.start(dir) || !chain.advance(sampler, rays)) return false;
    for (int i = 1; i < kind.count; ++i)
      if (!chain.bend(kind.bounces[i - 1]) || !chain.advance(sampler, rays)) return false;
    return true;
  }
};

inline const ChainKind kMirror{1, {Bounce::kReflect}};
inline const ChainKind kEntry{1, {Bounce::kTransmit}};
inline const ChainKind kThrough{2, {Bounce::kTransmit, Bounce::kTransmit}};

}  // namespace nephroid::test
