// How large the cells of photons may be in a scene: measured before the first batch.
//
// A footprint is where neighbours would end if light moved over the receiver as straight as it does next to the photon.
// Smooth surfaces keep to that over wide cells; a fine relief does not, and there wide cells are a blur. So some
// photons get a neighbour within their cell, whose true end is held against the footprint.
#pragma once

#include <cstdint>
#include <vector>

#include "techniques/reference/light_tracer.h"

namespace nephroid {

/// For each emitter, the largest overlap (see scaleFootprints) at which neighbours still end where footprints say; the
/// least of those tried if they never do. Deterministic.
/// @param tracer   spreads over a view
/// @param photons  of each emitter in the first batch
std::vector<float> chooseFootprintOverlaps(const LightTracer& tracer, const std::vector<std::uint32_t>& photons,
                                           std::uint32_t seed);

}  // namespace nephroid
