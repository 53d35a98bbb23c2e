// Path tracing from the eye with next-event estimation and multiple importance sampling (Kajiya 1986; Veach 1997).
//
// Makes every path but those that are left to photons, which find light that begins with S far faster (PhotonPaths);
// where lights have a size it can make those too. Each class of events (S, D) is its own integrand with its own
// weights, so that a contribution always belongs to exactly one layer.
// Where clear glass both mirrors and transmits a path follows both ways, as long as the lesser is worth it (splitting,
// Arvo & Kirk 1990): what glass mirrors, a twenty-fifth, is else found by one path in twenty-five. In long renders the
// lesser is followed as often as it pays (continuation.h).
// Caustics in mirrors and through glass, L S⁺ D S⁺ E, and what they light in turn, L S … D … D S⁺ E, are gathered from
// photons where a path from the eye first meets D (progressive photon mapping in the form of Knaus & Zwicker 2011):
// biased by the kernel's width, which shrinks.
// Limits: point lights and suns without a size cannot be met by chance, so what begins with S and is not left to
// photons is black for them.
#pragma once

#include <cstdint>
#include <vector>

#include "techniques/reference/continuation.h"
#include "techniques/reference/direction_guide.h"
#include "techniques/reference/film.h"
#include "techniques/reference/gathered_photons.h"
#include "techniques/reference/manifold/manifold.h"
#include "techniques/reference/path_class.h"
#include "techniques/reference/penumbra_finder.h"
#include "techniques/reference/world.h"

namespace nephroid {

struct PathCounters {
  std::uint64_t rays = 0, kernels = 0;  ///< traced, and gathered
  std::uint64_t not_finite = 0;
  // Filled if there:
  PartTally* parts = nullptr;
  std::vector<DirectionLesson>* lessons = nullptr;  ///< one for each way on from a path's first diffuse surface
  std::vector<vec3>* gather_places = nullptr;       ///< where photons were gathered, world, m
  PenumbraFinder* penumbrae = nullptr;              ///< asked as well, for how many light samples to draw

  /// How long it took, in rays: five kernels take as long as one, measured on `seabed`, `pool` and `wave`. Counted and
  /// not timed, for equal renders must take equal steps.
  std::uint64_t work() const { return rays + kernels / 5; }
};

class PathTracer {
 public:
  PathTracer(const ReferenceWorld& world, const LayerNeeds& needs) : world_(world), needs_(needs) {}
  /// From now on these paths are not looked for by chance.
  void leaveToPhotons(const PhotonPaths& paths) { left_ = paths; }
  /// From now on these photons are gathered; they must outlive the paths and may be none.
  /// @param paths  which of them
  void gatherFrom(const GatheredPhotons* photons, const PhotonPaths& paths) {
    photons_ = photons;
    gathered_ = paths;
  }
  /// From now on caustics over one or two interfaces, seen directly or not, are found by this, which must outlive it.
  void walkFrom(const Manifold* manifold) { manifold_ = manifold; }
  /// From now on paths go on by this.
  void continueBy(const Continuation& continuation) { continuation_ = continuation; }
  /// From now on paths draw their ways on from the first diffuse surface by this as well, which must outlive them and
  /// may be none.
  void guideBy(const DirectionGuide* guide) { guide_ = guide; }
  /// Is there use for a PenumbraFinder?
  bool mayDrawSeveralLightSamples() const;
  /// One path through pixel (x, y), added to the film. Safe from any thread as long as no two share a pixel.
  void tracePath(int x, int y, std::uint32_t sample, Film& film, PathCounters& counters) const {
    tracePath(x, y, sample, film, counters, continuation_);
  }
  /// The same, going on by another continuation.
  void tracePath(int x, int y, std::uint32_t sample, Film& film, PathCounters& counters,
                 const Continuation& continuation) const;

 private:
  const ReferenceWorld& world_;
  const LayerNeeds& needs_;
  const GatheredPhotons* photons_ = nullptr;
  PhotonPaths left_, gathered_;
  const Manifold* manifold_ = nullptr;
  Continuation continuation_;
  const DirectionGuide* guide_ = nullptr;
};

}  // namespace nephroid
