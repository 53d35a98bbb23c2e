// The eye's half of vertex connection and merging ([georgiev-2012-vcm]): paths E S* D S*, which meet photons, connect
// to their vertices, find lights and meet them by chance.
//
// Makes the layers `caustic` (L S⁺ D E) and `specular_caustic` (L S⁺ D S⁺ E), with what else holds them; each
// contribution has its weight of vcm/weights.h.
#pragma once

#include <span>

#include "techniques/reference/film.h"
#include "techniques/reference/path_tracer.h"
#include "techniques/reference/vcm/light_vertex.h"
#include "techniques/reference/vcm/techniques.h"
#include "trace/photon_grid.h"

namespace nephroid {

/// The photons of one batch; flux in W.
struct VcmPhotons {
  BasicPhotonGrid<VcmPhoton> grid;
  // Only where anything connects; of both, each vertex from the eye draws one.
  std::vector<VcmLightVertex> rough, ends;
};

/// One path through pixel (x, y), added to the film. Safe from any thread as long as no two share a pixel.
void traceVcmEyePath(const VcmTechniques& techniques, const VcmPhotons& photons, const LayerNeeds& needs, int x, int y,
                     std::uint32_t sample, Film& film, PathCounters& counters);

}  // namespace nephroid
