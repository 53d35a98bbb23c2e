// `nephroid info`: what is in a scene and how light will see it.
#include "app/cli/command.h"
#include "app/cli/options.h"
#include "app/cli/scene_options.h"
#include "app/cli/terminal.h"
#include "scene/report.h"

namespace nephroid::cli {
namespace {

constexpr const char* kExamples = R"(Examples:
  nephroid info glass.glb
  nephroid info builtin:cognac?light=area --json
  nephroid info cup.glb --material 'glaze:roughness=0.1')";

struct InfoOptions {
  SceneOptions scene;
  float specular_alpha = kDefaultSpecularAlpha;
  bool json = false;
};

ExitCode runInfo(const InfoOptions& options) {
  const SceneData scene = loadEditedScene(options.scene, options.scene.time, /*print_warnings=*/false);
  const SceneReport report = inspectScene(scene, options.specular_alpha);
  std::string text = options.json ? formatReportJson(scene, report) : formatReport(scene, report);
  if (!text.ends_with('\n')) text += '\n';
  writeStdout(text);
  return ExitCode::kDone;
}

}  // namespace

Command addInfoCommand(CLI::App& root) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App* app = addCommand(
      root, "info", "Describe a scene: geometry, materials, what casts and what catches caustics, lights, warnings.",
      kExamples);
  addSceneOptions(*app, options->scene);
  addValue(*app, "--specular-alpha", options->specular_alpha, "ALPHA",
           {"The widest microfacet lobe that still counts as specular.", "0.25", "0 to 1", ""}, checkNumber(0, 1));
  addSwitch(*app, "--json", options->json, "Print JSON.");
  return {app, [app, options] {
            if (!options->scene.state.empty()) applyStateFile(*app, options->scene.state);
            return runInfo(*options);
          }};
}

}  // namespace nephroid::cli
