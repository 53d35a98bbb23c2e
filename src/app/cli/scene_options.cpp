#include "app/cli/scene_options.h"

#include <fmt/format.h>

#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "nephroid/error.h"
#include "scene/edit.h"

namespace nephroid::cli {
namespace {

constexpr float kMaxTime = 1e6F;  // s; beyond, a float no longer resolves a frame

FloorMode parseFloor(const std::string& text) {
  if (text == "on") return FloorMode::kOn;
  return text == "off" ? FloorMode::kOff : FloorMode::kAuto;
}

void addEnvironmentOptions(CLI::App& app, SceneOptions& options) {
  addValue(app, "--env", options.environment, "MAP|sky",
           {"Light from all around: a latitude-longitude picture (.exr, .hdr), or the analytic sky with "
            "sky[:turbidity=..,elevation=..,azimuth=..,irradiance=..].",
            "the scene's own", "", ""});
  addValue(app, "--env-rotation", options.environment_rotation_deg, "DEG",
           {"Turns the environment about the vertical.", "0", "-360 to 360", "deg"}, checkNumber(-360, 360));
  addValue(app, "--env-scale", options.environment_scale, "X",
           {"Multiplies the radiance of the environment.", "1", "0 to 1e9", ""}, checkNumber(0, 1e9));
}

void applyEnvironment(SceneData& scene, const SceneOptions& options) {
  const float rotation_deg = options.environment_rotation_deg.value_or(0.0F);
  const float scale = options.environment_scale.value_or(1.0F);
  if (!options.environment.empty()) {
    scene.environment = loadEnvironment(options.environment, rotation_deg, scale);
  } else if (options.environment_rotation_deg || options.environment_scale) {
    if (!scene.environment)
      throw UsageError(
          fmt::format("--env-rotation, --env-scale: {} has no environment; give one with --env", scene.name));
    scene.environment->rotation_deg += rotation_deg;
    scene.environment->scale *= scale;
  }
}

}  // namespace

void addSceneOptions(CLI::App& app, SceneOptions& options) {
  addValue(app, "SCENE", options.scene, "SCENE",
           {"A .glb or .gltf file, or builtin:NAME[?key=value&..]; 'nephroid scenes' lists those.", "", "", ""});
  beginGroup(app, "Scene");
  addValue(app, "--time", options.time, "T", {"The moment of an animation.", "0", "0 to 1e6", "s"},
           checkNumber(0, kMaxTime));
  addList(
      app, "--light", options.lights, "EDIT",
      {"NAME:key=value,.. changes a light; sun:azimuth=A,elevation=E,irradiance=X, point:.. or spot:.. add one where "
       "no light has that name. Keys: position, direction, azimuth, elevation (deg), intensity (W/sr), irradiance "
       "(W/m^2), color, radius (m), angle, inner, outer (deg), off.",
       "none", "", ""});
  addList(app, "--object", options.objects, "EDIT",
          {"NAME:key=value,.. moves an object. Keys: translate=x,y,z (m), rotate=x,y,z (deg), scale=s, "
           "cast=true|false. NAME may hold * and ?.",
           "none", "", ""});
  addList(app, "--material", options.materials, "EDIT",
          {"GLOB:key=value,.. changes materials by their name or that of their object. Keys: ior, transmission, "
           "thickness (m), roughness, metallic, baseColor, abbe, dispersion, attenuation (colour), attenuationDistance "
           "(m), emission (W/m^2/sr), specular, priority, eta, k.",
           "none", "", ""});
  addEnvironmentOptions(app, options);
  addValue(app, "--floor", options.floor, "MODE",
           {"A floor under the scene; auto: only where nothing catches light.", "auto", "auto|on|off", ""},
           checkChoice({"auto", "on", "off"}));
  addValue(app, "--state", options.state, "FILE",
           {"A JSON object with any of these options under their long names, such as {\"samples\": 64, \"light\": "
            "[\"sun:elevation=30\"]}; the command line wins.",
            "none", "", ""});
  endGroup(app);
}

void addCameraOption(CLI::App& app, std::string& camera) {
  beginGroup(app, "Scene");
  addValue(
      app, "--camera", camera, "CHOICE",
      {"NAME or INDEX of a camera of the scene, or eye=x,y,z:target=x,y,z:fov=DEG[:ortho=H] (m; fov is the vertical "
       "angle, ortho the height of a parallel view).",
       "the first", "", ""});
  endGroup(app);
}

SceneData loadEditedScene(const SceneOptions& options, float time_s, bool print_warnings) {
  if (options.scene.empty())
    throw UsageError("no SCENE given; name a .glb or .gltf file, or a built-in scene such as builtin:ring");
  SceneData scene = loadScene(options.scene, {.time = time_s});
  applyEnvironment(scene, options);
  for (const std::string& edit : options.lights) applyLightEdit(scene, edit);
  for (const std::string& edit : options.objects) applyObjectEdit(scene, edit);
  for (const std::string& edit : options.materials) applyMaterialEdit(scene, edit);
  completeScene(scene, parseFloor(options.floor));
  if (print_warnings)
    for (const std::string& warning : scene.warnings) warnOnce(warning);
  return scene;
}

std::map<std::string, std::string> describeSceneOptions(const SceneOptions& options) {
  std::map<std::string, std::string> facts{
      {"scene", options.scene}, {"time", fmt::format("{}", options.time)}, {"floor", options.floor}};
  if (!options.environment.empty()) facts["env"] = options.environment;
  if (options.environment_rotation_deg || options.environment_scale) {
    facts["env-rotation"] = fmt::format("{}", options.environment_rotation_deg.value_or(0.0F));
    facts["env-scale"] = fmt::format("{}", options.environment_scale.value_or(1.0F));
  }
  const auto add_list = [&facts](const char* key, const std::vector<std::string>& edits) {
    if (!edits.empty()) facts[key] = fmt::format("{}", fmt::join(edits, " "));
  };
  add_list("light", options.lights);
  add_list("object", options.objects);
  add_list("material", options.materials);
  return facts;
}

}  // namespace nephroid::cli
