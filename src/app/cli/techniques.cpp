// `nephroid techniques`: the ways to draw caustics and their parameters.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/cli/command.h"
#include "app/cli/options.h"
#include "app/cli/param_text.h"
#include "app/cli/terminal.h"
#include "techniques/technique.h"

namespace nephroid::cli {
namespace {

constexpr const char* kExamples = R"(Examples:
  nephroid techniques
  nephroid techniques reference --json)";

struct TechniquesOptions {
  std::string name;
  bool json = false;
};

std::string formatTechnique(const Technique& technique) {
  return formatHeading(technique.name, technique.text, technique.source) + formatParams(technique.params) + "\n";
}

nlohmann::ordered_json toJson(const Technique& technique) {
  return {{"name", technique.name},
          {"text", technique.text},
          {"source", technique.source},
          {"params", paramsToJson(technique.params)}};
}

ExitCode runTechniques(const TechniquesOptions& options) {
  if (!options.name.empty()) findTechnique(options.name);
  std::string text;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Technique& technique : techniques()) {
    if (!options.name.empty() && technique.name != options.name) continue;
    text += formatTechnique(technique);
    list.push_back(toJson(technique));
  }
  writeStdout(options.json ? list.dump(2) + "\n" : text);
  return ExitCode::kDone;
}

}  // namespace

Command addTechniquesCommand(CLI::App& root) {
  const auto options = std::make_shared<TechniquesOptions>();
  CLI::App* app =
      addCommand(root, "techniques", "List the techniques with the parameters that --set takes.", kExamples);
  addValue(*app, "NAME", options->name, "NAME", {"Only this technique.", "all", "", ""});
  addSwitch(*app, "--json", options->json, "Print JSON.");
  return {app, [options] { return runTechniques(*options); }};
}

}  // namespace nephroid::cli
