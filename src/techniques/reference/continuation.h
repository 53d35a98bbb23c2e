// How often paths that mirrors or glass sent to a diffuse surface go on from there, and take both ways at glass, where
// what they may still find is worth little: under water, all light that a surface gets has come through the water's
// own, and photons bring it.
//
// A variance V of paths that cost T rays is lessened most where each part of a path is followed at a rate of
// √(second moment of what it brings / its rays) over √(V / T) (efficiency-optimised Russian roulette, Veach 1997,
// section 10.4.1). The parts here: what is beyond the k-th diffuse event, and what comes by the lesser of two ways at
// clear glass, such as its mirror image, whatever its events.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "techniques/reference/path_class.h"

namespace nephroid {

/// Which part of a path comes after these events: part 0 is all of those whose first event is diffuse as well.
struct PathPart {
  static constexpr std::size_t kCount = 5;

  static std::size_t of(const PathClass& events) {
    if (events.firstIsDiffuse()) return 0;
    return std::min(static_cast<std::size_t>(events.diffuseCount()), kCount - 1);
  }
};

/// Probability with which a path goes on into a part, by PathPart, from the part before.
struct Continuation {
  std::array<float, PathPart::kCount> probability;
  float lesser_way = 1.0F;  ///< probability that of two ways at clear glass the lesser is followed as well
  Continuation() { probability.fill(1.0F); }
  float into(const PathClass& events) const { return probability[PathPart::of(events)]; }
};

/// What paths brought and cost, by PathPart.
struct PartTally {
  std::array<double, PathPart::kCount> squares{};  ///< Σ of squared radiance, over contributions and channels
  std::array<double, PathPart::kCount> rays{};
  double lesser_squares = 0.0, lesser_rays = 0.0;  ///< of those, what came by lesser ways at clear glass
};

/// The probabilities that lessen the variance most for its cost, on the safe side: what few paths measured of rare
/// light is too little more often than too much.
/// @param tally     of paths that always went on; squares relative to the picture
/// @param variance  of all those paths together, in the same units, summed as the squares are
Continuation chooseContinuation(const PartTally& tally, double variance);

}  // namespace nephroid
