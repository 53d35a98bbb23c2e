// Where paths from the eye gather photons: of all that lights send, what ends elsewhere is of no use to them.
#pragma once

#include "techniques/reference/path_tracer.h"
#include "techniques/reference/world.h"
#include "trace/photon_grid.h"

namespace nephroid {

/// Some of those places, and what is near them. Immutable; safe from any thread.
class GatherPlaces {
 public:
  /// By a small picture of its own. @param width,height  of the picture that is meant
  /// @param tracer  that gathers them, about `world`; there need not be photons yet  @param needs  of the tracer
  GatherPlaces(ReferenceWorld& world, const Camera& camera, int width, int height, const PathTracer& tracer,
               const LayerNeeds& needs);

  bool empty() const { return grid_.empty(); }
  /// Is `position` so near to one that there may well be others between?
  bool isNear(vec3 position) const;

 private:
  PhotonGrid grid_;
};

}  // namespace nephroid
