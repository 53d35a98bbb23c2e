#include "app/cli/help.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/cli/command.h"
#include "app/cli/terminal.h"

namespace nephroid::cli {
namespace {

constexpr std::size_t kWidth = 80;

bool isRoot(const CLI::App& app) { return app.get_parent() == nullptr; }

std::string formatCommands(const CLI::App& root) {
  std::string text = "Commands:\n";
  for (const CLI::App* command : root.get_subcommands(nullptr))
    text += fmt::format("  {:<12} {}\n", command->get_name(), command->get_description());
  return text + "\n";
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
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    if (!line.empty() && indent + line.size() + 1 + word.size() > width) {
      lines += margin + line + "\n";
      line.clear();
    }
    if (!line.empty()) line += ' ';
    line += word;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines + margin + line + "\n";
}

std::string formatEntry(const std::string& name, const std::string& description) {
  return fmt::format("  {}\n{}", name, wrapText(description, 6, kWidth));
}

std::string formatUsage(const CLI::App& app) {
  if (isRoot(app)) return "nephroid COMMAND [ARGUMENTS] [OPTIONS]";
  std::string text = "nephroid " + app.get_name();
  for (const CLI::Option* option : app.get_options())
    if (option->get_positional()) text += " " + option->get_name(true);
  return text + " [OPTIONS]";
}

std::string formatHelp(const CLI::App& app) {
  std::string text = wrapText(app.get_description(), 0, kWidth) + "\nUsage: " + formatUsage(app) + "\n\n";
  if (isRoot(app)) text += formatCommands(app);
  for (const OptionGroup& group : groupOptions(app)) {
    text += group.name + ":\n";
    for (const CLI::Option* option : group.options)
      text += formatEntry(formatFlags(*option), option->get_description());
    text += "\n";
  }
  return text + app.get_footer() + "\n";
}

Command addHelpCommand(CLI::App& root) {
  const auto topic = std::make_shared<std::string>();
  CLI::App* app = root.add_subcommand("help", "Explain a command, as its --help does.");
  app->add_option("COMMAND", *topic, "The command to explain.")->type_name("COMMAND");
  return {app, [&root, topic] {
            const CLI::App* found = topic->empty() ? &root : nullptr;
            for (const CLI::App* command : root.get_subcommands(nullptr))
              if (command->get_name() == *topic) found = command;
            if (found == nullptr)
              throw UsageError(fmt::format("no command '{}'; 'nephroid --help' lists them", *topic));
            writeStdout(formatHelp(*found));
            return ExitCode::kDone;
          }};
}

}  // namespace nephroid::cli
