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

/// What paths brought and cost, by PathPart, about as if they had always gone on: those that weigh more, as they went
/// on seldom, are split for longer at glass, which counts up to half more rays of the later parts.
struct PartTally {
  std::array<double, PathPart::kCount> squares{};  ///< Σ of squared radiance, over contributions and channels
  std::array<double, PathPart::kCount> rays{};
  double lesser_squares = 0.0, lesser_rays = 0.0;  ///< of those, what came by lesser ways at clear glass
  double excess = 0.0;                             ///< Σ of squared radiance that is there for want of always going on

  /// @param scale  of squares  @param ray_scale  of rays
  void add(const PartTally& other, double scale, double ray_scale) {
    for (std::size_t part = 0; part < PathPart::kCount; ++part)
      squares[part] += scale * other.squares[part], rays[part] += ray_scale * other.rays[part];
    lesser_squares += scale * other.lesser_squares, lesser_rays += ray_scale * other.lesser_rays;
    excess += scale * other.excess;
  }
};

/// Rates are so many times those that were measured to be the best, and no less than the least: too low a rate turns
/// what the measurement missed into noise, too high a one only costs rays.
struct RateLimits {
  double safety, least;
  double lesser_safety, least_lesser;  ///< of lesser ways
};
/// For what few paths measured. Of `slab` the variance of a pilot is a hundred times that of a render, by outlines,
/// which many points that are spread well resolve: hence the safety of lesser ways.
inline constexpr RateLimits kPilotLimits{.safety = 2.0, .least = 0.5, .lesser_safety = 8.0, .least_lesser = 0.25};

/// The probabilities that lessen the variance most for its cost, within limits.
/// @param tally     squares relative to the picture
/// @param variance  of all those paths together, had they always gone on, in the same units, summed as the squares are
Continuation chooseContinuation(const PartTally& tally, double variance, const RateLimits& limits = kPilotLimits);

}  // namespace nephroid
