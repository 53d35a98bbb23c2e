// The options that name a scene and change it, shared by the subcommands that load one.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options.h"
#include "scene/load.h"
#include "scene/scene_data.h"

namespace nephroid::cli {

struct SceneOptions {
  std::string scene;
  float time = 0;  ///< s
  std::string floor = "auto";
  std::string environment;
  std::optional<float> environment_rotation_deg, environment_scale;
  std::vector<std::string> lights, objects, materials;
  std::string state;  ///< JSON file with further options
};

/// Declares SCENE and the options of the scene.
void addSceneOptions(CLI::App& app, SceneOptions& options);

/// `--camera`, for the subcommands that look at the scene.
void addCameraOption(CLI::App& app, std::string& camera);

/// Loads the scene as it is at `time_s`, edits it (environment, lights, objects, materials), completes it (floor,
/// light, camera where there is none) and prints its new warnings.
/// @throws InputError, UsageError
SceneData loadEditedScene(const SceneOptions& options, float time_s, bool print_warnings = true);

/// What was asked for, for the metadata of pictures: "scene", "time", "light", ….
std::map<std::string, std::string> describeSceneOptions(const SceneOptions& options);

}  // namespace nephroid::cli
