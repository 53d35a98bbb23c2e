// Measures which parts of paths from the eye are worth following, before a render.
#pragma once

#include "techniques/reference/continuation.h"
#include "techniques/reference/film.h"
#include "techniques/reference/world.h"

namespace nephroid {

/// What a render leaves to photons, and how.
struct PhotonShare {
  PhotonPaths left;      ///< by paths from the eye: to photons
  PhotonPaths connect;   ///< to the camera
  PhotonPaths gathered;  ///< by paths from the eye
};

/// By a small picture, which takes 12 000 paths and 33 000 photons.
/// @param world  seen by `camera`, `width` × `height` pixels; others meanwhile
Continuation measureContinuation(ReferenceWorld& world, const Camera& camera, int width, int height,
                                 const LayerNeeds& needs, const PhotonShare& share);

}  // namespace nephroid
