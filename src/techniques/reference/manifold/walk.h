// Newton's method on the specular manifold: from a chain somewhere near to one that reaches the light.
#pragma once

#include <optional>

#include "techniques/reference/manifold/specular_chain.h"

namespace nephroid {

/// How a chain goes: its events from the receiver to the light.
struct ChainKind {
  int count = 0;
  std::array<Bounce, kMaxManifoldEvents> bounces{};
  friend bool operator==(const ChainKind&, const ChainKind&) = default;
  Bounce last() const { return bounces[count - 1]; }
};

/// What a chain ends on.
struct ChainEnd {
  vec3 light;  ///< place, m, or unit direction towards a light at infinity
  bool at_infinity = false;
};

/// Two chains to swap, for one receiver: steps that lead nowhere are taken back.
class ManifoldWalk {
 public:
  ManifoldWalk(const ReferenceWorld& world, const ChainReceiver& receiver)
      : chains_{{world, receiver}, {world, receiver}} {}

  /// The chain to seed, then to read where `solve` has led to.
  SpecularChain& chain() { return chains_[current_]; }

  /// From the seeded chain to one that reaches the end.
  ///
  /// Newton steps on the starting direction; a step that loses the surfaces or does not lessen the residual is halved.
  /// @param scale  a length of the surfaces, m: what is solved for is known to kPrecision of it
  /// @return       false if it did not get there, or arrived on the wrong side of the last surface
  bool solve(const ChainKind& kind, const ChainEnd& end, float scale, Sampler& sampler, std::uint64_t& rays);

  /// Places on surfaces are found to this share of their size; single precision has 6e-8.
  static constexpr float kPrecision = 1e-5F;

 private:
  bool retrace(SpecularChain& chain, vec3 dir, const ChainKind& kind, Sampler& sampler, std::uint64_t& rays) const;

  SpecularChain chains_[2];
  int current_ = 0;
};

}  // namespace nephroid
