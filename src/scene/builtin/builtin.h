// The built-in scenes: procedural, parameterised, so that a first run needs no download.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/params.h"
#include "scene/scene_data.h"

namespace nephroid {

/// One built-in scene: an entry of the explicit list in builtin.cpp.
struct BuiltinScene {
  std::string name;
  std::string text;    ///< what it shows, one sentence
  std::string source;  ///< where it comes from, e.g. "Shah et al., Fig. 12"
  std::vector<ParamSpec> params;
  SceneData (*build)(const ParamSet& params, float time);
};

std::span<const BuiltinScene> builtinScenes();

/// @param query "NAME" or "NAME?key=value&key=value"
/// @throws UsageError with the names that exist
SceneData buildBuiltinScene(std::string_view query, float time);

}  // namespace nephroid
