// Path tracing from the eye with next-event estimation and multiple importance sampling (Kajiya 1986; Veach 1997).
//
// Makes every layer but the paths L S … D E, which light tracing finds far faster (see light_tracer.h); with
// `light_tracing` off it makes those too, where lights have a size. Each class of events (S, D) is its own integrand
// with its own weights, so that a contribution always belongs to exactly one layer.
// Limits: point lights and suns without a size cannot be met by chance, so L S … S E is black for them.
#pragma once

#include <cstdint>

#include "techniques/reference/film.h"
#include "techniques/reference/world.h"

namespace nephroid {

struct PathCounters {
  std::uint64_t rays = 0;
  std::uint64_t not_finite = 0;
};

class PathTracer {
 public:
  PathTracer(const ReferenceWorld& world, const LayerNeeds& needs) : world_(world), needs_(needs) {}
  /// One path through pixel (x, y), added to the film. Safe from any thread as long as no two share a pixel.
  void tracePath(int x, int y, std::uint32_t sample, Film& film, PathCounters& counters) const;

 private:
  const ReferenceWorld& world_;
  const LayerNeeds& needs_;
};

}  // namespace nephroid
