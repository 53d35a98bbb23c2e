// From what a user names to a scene that can be rendered.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/scene_data.h"

namespace nephroid {

struct LoadOptions {
  float time = 0.0F;  ///< s, for node animation and time-dependent built-in scenes
};

/// Loads `source`: a .glb/.gltf file, or "builtin:NAME[?key=value&…]". Neither floor, light nor camera is added here;
/// see `completeScene`.
/// @throws InputError (file), UsageError (unknown built-in scene or parameter)
SceneData loadScene(std::string_view source, const LoadOptions& options = {});

enum class FloorMode { kAuto, kOn, kOff };

/// Makes any scene renderable, and says in `scene.warnings` what it added: a sun (elevation 45°, E⊥ = 10 W/m²) where
/// there is no light of any kind, a floor under the lowest point where nothing receives (kAuto) or always (kOn), and a
/// camera that frames everything where there is none.
void completeScene(SceneData& scene, FloorMode floor = FloorMode::kAuto);

}  // namespace nephroid
