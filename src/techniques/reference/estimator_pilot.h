// A short look at a scene before the render: do photons or paths from the eye make its caustics at less cost?
//
// Both are let loose on a small picture, and their errors at equal cost compared: noise, and the bias of kernels. Cost
// is counted in rays, never in seconds, and the random numbers are the same for any seed, so equal scenes are judged
// alike on any machine.
#pragma once

#include <optional>

#include "techniques/reference/film.h"
#include "techniques/reference/world.h"

namespace nephroid {

/// How well both make one kind of caustic: relMSE at the same cost, that of what photons did.
struct EstimatorFigures {
  double photons = 0.0, paths = 0.0;
  double contributions = 0.0;  ///< of paths: as many equal ones would be as sure (Kish's effective sample size)
  double found = 0.0;          ///< of the light that photons bring, the share that paths have met

  /// Only if it is beyond doubt. What paths have not met yet is not in their spread, and so makes them look good: many
  /// must have contributed, nearly all of the light must be there, and the gain be more than the figures may err.
  bool pathsAreBetter() const;
};

struct PilotFigures {
  std::optional<EstimatorFigures> caustic;           ///< L S⁺ D E: photons in pixels against paths
  std::optional<EstimatorFigures> specular_caustic;  ///< L S⁺ D S⁺ E: a photon map against paths
};

/// Nothing for what is not needed, for scenes with a light without a size, and where so few paths meet a light that
/// there is no need to look at photons.
/// @param world   its camera and seed are others meanwhile
/// @param camera  of the picture, `width` × `height`
PilotFigures measureEstimators(ReferenceWorld& world, const Camera& camera, int width, int height,
                               const LayerNeeds& needs);

}  // namespace nephroid
