// Path tracing from the eye with next-event estimation and multiple importance sampling (Kajiya 1986; Veach 1997).
//
// Makes every layer but the paths L S … D E, which light tracing finds far faster (see light_tracer.h); with
// `light_tracing` off it makes those too, where lights have a size. Each class of events (S, D) is its own integrand
// with its own weights, so that a contribution always belongs to exactly one layer.
// Caustics in mirrors and through glass, L S⁺ D S⁺ E, are gathered from photons where a path from the eye ends on D
// (progressive photon mapping in the form of Knaus & Zwicker 2011): biased by the kernel's width, which shrinks.
// Limits: point lights and suns without a size cannot be met by chance, so other paths L S … S E are black for them.
#pragma once

#include <cstdint>

#include "techniques/reference/film.h"
#include "techniques/reference/manifold/manifold.h"
#include "techniques/reference/world.h"
#include "trace/photon_grid.h"

namespace nephroid {

struct PathCounters {
  std::uint64_t rays = 0;
  std::uint64_t not_finite = 0;
};

class PathTracer {
 public:
  PathTracer(const ReferenceWorld& world, const LayerNeeds& needs) : world_(world), needs_(needs) {}
  /// From now on L S⁺ D S⁺ E is gathered from these photons (flux in W) and not looked for by chance; `grid` must
  /// outlive the paths and may be empty.
  /// @param direct_too  L S⁺ D E as well
  void gatherFrom(const PhotonGrid* grid, bool direct_too) {
    caustics_ = grid;
    gather_direct_ = direct_too;
    leave_caustics_ = true;
  }
  /// From now on L S⁺ D S⁺ E is left to others.
  void leaveCaustics() { leave_caustics_ = true; }
  /// From now on caustics over one or two interfaces, seen directly or not, are found by this, which must outlive it.
  void walkFrom(const Manifold* manifold) { manifold_ = manifold; }
  /// One path through pixel (x, y), added to the film. Safe from any thread as long as no two share a pixel.
  void tracePath(int x, int y, std::uint32_t sample, Film& film, PathCounters& counters) const;

 private:
  const ReferenceWorld& world_;
  const LayerNeeds& needs_;
  const PhotonGrid* caustics_ = nullptr;
  const Manifold* manifold_ = nullptr;
  bool gather_direct_ = false, leave_caustics_ = false;
};

}  // namespace nephroid
