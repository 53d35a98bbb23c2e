// `nephroid manual`: the manual page, from the same declarations as --help.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include "app/cli/command.h"
#include "app/cli/help.h"
#include "app/cli/terminal.h"
#include "nephroid/nephroid.h"

namespace nephroid::cli {
namespace {

/// Protects what roff would take for its own: backslashes, hyphens (which would become typographic) and a leading
/// dot or quote.
std::string escapeRoff(std::string_view text) {
  std::string escaped;
  bool at_line_start = true;
  for (const char c : text) {
    if (at_line_start && (c == '.' || c == '\'')) escaped += "\\&";
    if (c == '\\')
      escaped += "\\e";
    else if (c == '-')
      escaped += "\\-";
    else if (c == '|')
      escaped += "|\\:";  // a list of choices may break here
    else
      escaped += c;
    at_line_start = c == '\n';
  }
  return escaped;
}

std::string formatOptions(const CLI::App& app) {
  std::string text;
  for (const OptionGroup& group : groupOptions(app))
    for (const CLI::Option* option : group.options)
      text += fmt::format(".TP\n.B {}\n{}\n", escapeRoff(formatFlags(*option)), escapeRoff(option->get_description()));
  return text;
}

std::string formatCommand(const CLI::App& command) {
  std::string text =
      fmt::format(".SS {}\n{}\n.PP\n.B {}\n{}", escapeRoff(command.get_name()), escapeRoff(command.get_description()),
                  escapeRoff(formatUsage(command)), formatOptions(command));
  if (!command.get_footer().empty()) text += fmt::format(".PP\n.nf\n{}\n.fi\n", escapeRoff(command.get_footer()));
  return text;
}

constexpr const char* kExitStatus = R"(.SH EXIT STATUS
.TP
.B 0
Done.
.TP
.B 1
Internal failure; please report it.
.TP
.B 2
Wrong usage: an unknown option, a value out of range.
.TP
.B 3
Bad input: a file that is missing, broken or asks for what nephroid does not do.
.TP
.B 4
No suitable device; nephroid devices tells what each one lacks, and itself ends with 0.
.TP
.B 5
Out of memory or disk, or a path that cannot be written.
.TP
.B 130
Interrupted; a render keeps what it has.
)";

std::string formatManual(const CLI::App& root) {
  std::string text = fmt::format(
      ".TH NEPHROID 1 \"\" \"nephroid {}\" \"User Commands\"\n.ds AD l\n.ad l\n.nh\n.SH NAME\nnephroid \\- render "
      "caustics\n"
      ".SH SYNOPSIS\n.B {}\n.SH DESCRIPTION\n{}\n.SH OPTIONS\n{}.SH COMMANDS\n",
      version(), escapeRoff(formatUsage(root)), escapeRoff(root.get_description()), formatOptions(root));
  for (const CLI::App* command : root.get_subcommands(nullptr)) text += formatCommand(*command);
  return text + kExitStatus;
}

}  // namespace

Command addManualCommand(CLI::App& root) {
  CLI::App* app = addCommand(root, "manual", "Print the manual page (docs/nephroid.1), in roff.");
  return {app, [&root] {
            writeStdout(formatManual(root));
            return ExitCode::kDone;
          }};
}

}  // namespace nephroid::cli
