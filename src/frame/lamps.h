// Lights with a size, as the camera sees them.
#pragma once

#include <vector>

#include "frame/frame.shared.h"
#include "scene/scene_data.h"

namespace nephroid {

/// Spheres and suns that have a size and shine. They hide nothing: they stand for a filament, not for a body.
std::vector<LampRecord> makeLamps(const SceneData& scene);

}  // namespace nephroid
