// Whether two scenes are the same, to every bit that a picture could depend on.
#pragma once

#include <cstdint>

#include "scene/scene_data.h"

namespace nephroid {

/// Of geometry, materials, textures, lights and environment; not of cameras, warnings or the file's name.
std::uint64_t fingerprintScene(const SceneData& scene);
std::uint64_t fingerprintCamera(const Camera& camera);

}  // namespace nephroid
