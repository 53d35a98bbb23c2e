// The pictures that a light takes of what bends it: the domain of emission (seed [shah-caustics-mapping], §III-B).
#pragma once

#include <vector>

#include "frame/frame.shared.h"
#include "scene/scene_data.h"
#include "techniques/caustic_map/generator_hull.h"

namespace nephroid {

/// Views that together hold every ray from a light to a generator, none of them twice. Of parallel light a rectangle
/// across it; of a point a frustum where generators are small as seen from it, else those faces of a cube that show
/// some of them. Rectangle and frustum are those about the generators' convex hull, turned about the light where that
/// makes them smaller: what they hold beside a generator is light that is followed for nothing.
///
/// It asks the hull a few times for parallel light and some dozen times for a point, and the hull's outline some
/// hundred times.
///
/// Depths reach from before the first thing that could block the light to behind the last generator.
/// @param light       without its grid; points and parallel light alike
/// @param generators  not empty
/// @param scene       of everything, generators included
/// @return            their pictures have as many cells on either side; none for a spot whose cone does not reach the
///                    generators
std::vector<ViewRecord> makeEmissionViews(const LightRecord& light, const GeneratorHull& generators,
                                          const Bounds& scene);

}  // namespace nephroid
