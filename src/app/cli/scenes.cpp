// `nephroid scenes`: the built-in scenes and their parameters.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/cli/command.h"
#include "app/cli/options.h"
#include "app/cli/param_text.h"
#include "app/cli/terminal.h"
#include "scene/builtin/builtin.h"

namespace nephroid::cli {
namespace {

constexpr const char* kExamples = R"(Examples:
  nephroid scenes
  nephroid scenes prism
  nephroid render 'builtin:prism?light=spot' -o prism.png)";

struct ScenesOptions {
  std::string name;
  bool json = false;
};

std::vector<const BuiltinScene*> chooseScenes(const std::string& name) {
  std::vector<const BuiltinScene*> chosen;
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtinScenes()) {
    names.push_back(scene.name);
    if (name.empty() || scene.name == name) chosen.push_back(&scene);
  }
  if (!chosen.empty()) return chosen;
  const std::string near = suggestName(name, names);
  throw UsageError(fmt::format("no built-in scene '{}'; there are {}{}", name, fmt::join(names, ", "),
                               near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

std::string formatScene(const BuiltinScene& scene) {
  return formatHeading("builtin:" + scene.name, scene.text, scene.source) + formatParams(scene.params) + "\n";
}

nlohmann::ordered_json toJson(const BuiltinScene& scene) {
  return {{"name", scene.name}, {"text", scene.text}, {"source", scene.source}, {"params", paramsToJson(scene.params)}};
}

ExitCode runScenes(const ScenesOptions& options) {
  std::string text;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const BuiltinScene* scene : chooseScenes(options.name)) {
    text += formatScene(*scene);
    list.push_back(toJson(*scene));
  }
  writeStdout(options.json ? list.dump(2) + "\n" : text);
  return ExitCode::kDone;
}

}  // namespace

Command addScenesCommand(CLI::App& root) {
  const auto options = std::make_shared<ScenesOptions>();
  CLI::App* app = addCommand(root, "scenes", "List the built-in scenes with their parameters.", kExamples);
  addValue(*app, "NAME", options->name, "NAME", {"Only this scene.", "all", "", ""});
  addSwitch(*app, "--json", options->json, "Print JSON.");
  return {app, [options] { return runScenes(*options); }};
}

}  // namespace nephroid::cli
