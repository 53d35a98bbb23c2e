// Learns from where light reaches the surfaces of a picture, if that pays.
#pragma once

#include "techniques/reference/direction_guide.h"
#include "techniques/reference/path_tracer.h"

namespace nephroid {

/// From paths of a small picture, 64 000 without a guide and as many by what those learned; where these are worth
/// more, by their noise and their rays, another 256 000.
/// @param needs   the tracer's
/// @param tracer  as the render will use it; what guides it does not count
/// @return empty if ways by the BSDF alone are as good
DirectionGuide learnDirections(ReferenceWorld& world, const Camera& camera, int width, int height,
                               const LayerNeeds& needs, PathTracer tracer);

/// What is least in proportion to the time in which passes that go where they pay reach an error: (Σ √(variance ×
/// cost))², over tiles.
double timeToError(std::span<const double> variances, std::span<const double> costs);

}  // namespace nephroid
