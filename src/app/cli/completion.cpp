// `nephroid completion bash`: completion of commands, options, choices, scenes and techniques.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include "app/cli/command.h"
#include "app/cli/embedded.h"
#include "app/cli/help.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "scene/builtin/builtin.h"
#include "techniques/layers.h"
#include "techniques/technique.h"

namespace nephroid::cli {
namespace {

std::string joinWords(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

std::string formatCase(const std::string& key, const std::vector<std::string>& words) {
  return fmt::format("    '{}') printf '%s' '{}' ;;\n", key, joinWords(words));
}

std::vector<std::string> flagsOf(const CLI::App& app) {
  std::vector<std::string> flags;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_snames()) flags.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
  }
  return flags;
}

/// The choices in "[…; range: a|b|c; …]" of a description: the same words that --help shows.
std::vector<std::string> choicesOf(const CLI::Option& option) {
  const std::string& text = option.get_description();
  constexpr std::string_view kMark = "range: ";
  const std::size_t start = text.rfind(kMark);
  if (start == std::string::npos) return {};
  const std::size_t first = start + kMark.size();
  const std::string range = text.substr(first, text.find_first_of(";]", first) - first);
  const bool is_choice = range.find(' ') == std::string::npos && range.find('*') == std::string::npos;
  return is_choice ? splitList(range, '|') : std::vector<std::string>{};
}

std::vector<std::string> builtinNames(const std::string& prefix) {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtinScenes()) names.push_back(prefix + scene.name);
  return names;
}

std::vector<std::string> techniqueWords() {
  std::vector<std::string> names;
  for (const Technique& technique : techniques()) names.push_back(technique.name);
  return names;
}

std::string formatCommandCases(const CLI::App& command) {
  const std::string& name = command.get_name();
  std::string text = formatCase(name, flagsOf(command));
  for (const CLI::Option* option : command.get_options()) {
    const std::vector<std::string> choices = choicesOf(*option);
    for (const std::string& flag : option->get_lnames())
      if (!choices.empty()) text += formatCase(fmt::format("{} --{}", name, flag), choices);
    if (option->get_name(true).starts_with("SCENE")) text += formatCase(name + " SCENE", builtinNames("builtin:"));
  }
  return text;
}

std::string formatScript(const CLI::App& root) {
  std::vector<std::string> first = flagsOf(root);
  std::string cases;
  for (const CLI::App* command : root.get_subcommands(nullptr)) {
    first.push_back(command->get_name());
    cases += formatCommandCases(*command);
  }
  cases = formatCase("", first) + cases;
  cases += formatCase("scenes scenes", builtinNames("")) + formatCase("techniques techniques", techniqueWords());
  std::string parameters;
  for (const BuiltinScene& scene : builtinScenes()) {
    std::vector<std::string> names;
    for (const ParamSpec& spec : scene.params) names.push_back(spec.name);
    parameters += formatCase("builtin:" + scene.name, names);
  }
  std::string script = kCompletionScript;
  script.replace(script.find("@CASES@"), 7, cases);
  script.replace(script.find("@PARAMETERS@"), 12, parameters);
  return script;
}

}  // namespace

Command addCompletionCommand(CLI::App& root) {
  const auto shell = std::make_shared<std::string>("bash");
  CLI::App* app = addCommand(root, "completion", "Print the shell's completion script.",
                             "Example:\n  source <(nephroid completion bash)");
  addValue(*app, "SHELL", *shell, "SHELL", {"The shell.", "bash", "bash", ""}, checkChoice({"bash"}));
  return {app, [&root, shell] {
            writeStdout(formatScript(root));
            return ExitCode::kDone;
          }};
}

}  // namespace nephroid::cli
