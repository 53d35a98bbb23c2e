// Help: one walk over the declared options makes `--help`, the manual page and the shell completion.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/cli/options.h"

namespace nephroid::cli {

/// Columns of all help: what every terminal shows.
inline constexpr std::size_t kHelpWidth = 80;

/// Options of one group, in the order of their declaration.
struct OptionGroup {
  std::string name;
  std::vector<const CLI::Option*> options;
};

/// The options of `app` by group; positional arguments come first, as group "Arguments".
std::vector<OptionGroup> groupOptions(const CLI::App& app);

/// "-o, --output FILE".
std::string formatFlags(const CLI::Option& option);

/// A name and its description, wrapped and indented.
std::string formatEntry(const std::string& name, const std::string& description);

/// `text` broken at spaces, and at '|' in what is longer than a line, into lines of at most `width` columns, each after
/// `indent` spaces.
std::string wrapText(std::string_view text, std::size_t indent, std::size_t width);

/// Answers `nephroid help [COMMAND]`, which the parser would take for the command itself.
/// @return whether that is what the command line says
/// @throws UsageError for an unknown command
bool answerHelp(const CLI::App& root, std::span<char* const> arguments);

/// What `nephroid --help` (for the root) or `nephroid COMMAND --help` prints.
std::string formatHelp(const CLI::App& app);

/// "nephroid render SCENE [options]".
std::string formatUsage(const CLI::App& app);

}  // namespace nephroid::cli
