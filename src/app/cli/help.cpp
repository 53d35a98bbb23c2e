#include "app/cli/help.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/cli/command.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"

namespace nephroid::cli {
namespace {

bool isRoot(const CLI::App& app) { return app.get_parent() == nullptr; }

std::string formatCommands(const CLI::App& root) {
  std::string text = "Commands:\n";
  for (const CLI::App* command : root.get_subcommands(nullptr))
    text += formatEntry(command->get_name(), command->get_description());
  return text + "\n";
}

/// " SCENE", " [NAME]" where it has a default, " [SCENE...]" where several are taken.
std::string formatPositional(const CLI::Option& option) {
  const std::string name = option.get_name(true) + (option.get_items_expected_max() > 1 ? "..." : "");
  const bool is_optional = option.get_description().find("[default: ") != std::string::npos;
  return is_optional ? fmt::format(" [{}]", name) : fmt::format(" {}", name);
}

}  // namespace

std::vector<OptionGroup> groupOptions(const CLI::App& app) {
  std::vector<OptionGroup> groups;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_positional() ? "Arguments" : option->get_group();
    auto found = std::find_if(groups.begin(), groups.end(), [&](const OptionGroup& g) { return g.name == name; });
    if (found == groups.end()) found = groups.insert(groups.end(), OptionGroup{name, {}});
    found->options.push_back(option);
  }
  // "Options" holds --help and the rest; it reads best at the end.
  std::stable_partition(groups.begin(), groups.end(), [](const OptionGroup& g) { return g.name != "Options"; });
  std::stable_partition(groups.begin(), groups.end(), [](const OptionGroup& g) { return g.name == "Arguments"; });
  return groups;
}

std::string formatFlags(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true);
  std::vector<std::string> flags;
  for (const std::string& name : option.get_snames()) flags.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) flags.push_back("--" + name);
  std::string text = fmt::format("{}", fmt::join(flags, ", "));
  return option.get_expected_min() == 0 ? text : text + " " + option.get_type_name();
}

std::string wrapText(std::string_view text, std::size_t indent, std::size_t width) {
  std::string lines, line;
  const std::string margin(indent, ' ');
  bool glued = false;  // the next piece continues a word
  while (!text.empty()) {
    std::size_t end = std::min(text.find(' '), text.size());
    const std::size_t bar = text.find('|');
    if (bar < end && (glued || indent + end > width)) end = bar + 1;
    const std::string_view piece = text.substr(0, end);
    const std::string gap = line.empty() || glued ? "" : " ";
    if (!line.empty() && indent + line.size() + gap.size() + piece.size() > width) {
      lines += margin + line + "\n";
      line = piece;
    } else {
      line += gap;
      line += piece;
    }
    glued = end < text.size() && text[end] != ' ';
    text.remove_prefix(glued ? end : std::min(end + 1, text.size()));
  }
  return lines + margin + line + "\n";
}

std::string formatEntry(const std::string& name, const std::string& description) {
  return fmt::format("  {}\n{}", name, wrapText(description, 6, kHelpWidth));
}

std::string formatUsage(const CLI::App& app) {
  if (isRoot(app)) return "nephroid COMMAND [ARGUMENTS] [OPTIONS]";
  std::string text = "nephroid " + app.get_name();
  for (const CLI::Option* option : app.get_options())
    if (option->get_positional()) text += formatPositional(*option);
  return text + " [OPTIONS]";
}

std::string formatHelp(const CLI::App& app) {
  std::string text = wrapText(app.get_description(), 0, kHelpWidth) + "\nUsage: " + formatUsage(app) + "\n\n";
  if (isRoot(app)) text += formatCommands(app);
  for (const OptionGroup& group : groupOptions(app)) {
    text += group.name + ":\n";
    for (const CLI::Option* option : group.options)
      text += formatEntry(formatFlags(*option), option->get_description());
    text += "\n";
  }
  return text + app.get_footer() + "\n";
}

bool answerHelp(const CLI::App& root, std::span<char* const> arguments) {
  if (arguments.size() < 2 || std::string_view(arguments[1]) != "help") return false;
  const std::string topic = arguments.size() > 2 ? arguments[2] : "";
  if (topic.starts_with("-")) return false;
  const CLI::App* found = topic.empty() ? &root : nullptr;
  for (const CLI::App* command : root.get_subcommands(nullptr))
    if (command->get_name() == topic) found = command;
  if (found == nullptr) throw UsageError(fmt::format("no command '{}'; 'nephroid --help' lists them", topic));
  writeStdout(formatHelp(*found));
  return true;
}

Command addHelpCommand(CLI::App& root) {
  CLI::App* app = addCommand(root, "help", "Explain a command, as its --help does.");
  addParsed(*app, "COMMAND", [](const std::string&) {}, "COMMAND",
            {"The command to explain.", "the whole program", "", ""});
  return {app, [] { return ExitCode::kDone; }};
}

}  // namespace nephroid::cli
