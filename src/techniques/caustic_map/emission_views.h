// The pictures that a light takes of what bends it: the domain of emission (seed [shah-caustics-mapping], §III-B).
#pragma once

#include <cstdint>
#include <vector>

#include "frame/frame.shared.h"
#include "scene/scene_data.h"

namespace nephroid {

/// Of the instances that cast caustics; empty if there are none.
Bounds generatorBounds(const SceneData& scene, float specular_alpha);

/// Views that together hold every ray from a light to a generator, none of them twice: one of parallel light, fitted to
/// the generators; of a point one that is fitted to them where they are small as seen from it, else those faces of a
/// cube that show some of them.
///
/// Depths reach from before the first thing that could block the light to behind the last generator.
/// @param light       without its grid; points and parallel light alike
/// @param generators  not empty
/// @param scene       of everything, `generators` included
/// @return            their pictures are square; none for a spot whose cone does not reach the generators
std::vector<ViewRecord> makeEmissionViews(const LightRecord& light, const Bounds& generators, const Bounds& scene);

}  // namespace nephroid
