// The program `nephroid`: parses the command line, runs a subcommand, turns every failure into one line and an exit
// code.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <new>
#include <vector>

#include "app/cli/command.h"
#include "app/cli/help.h"
#include "app/cli/stop.h"
#include "app/cli/terminal.h"
#include "core/params.h"
#include "nephroid/nephroid.h"

namespace nephroid::cli {
namespace {

constexpr const char* kDescription =
    "Nephroid renders caustics: the bright patterns that glass, metal and water focus onto the things around them.";

constexpr const char* kFooter = R"(Start here:
  nephroid render builtin:ring -o ring.png
  nephroid scenes
  nephroid render --help

Results go to stdout or to the named file, everything else to stderr.
Exit codes: 0 done, 1 internal failure, 2 wrong usage, 3 bad input, 4 no
suitable device, 5 out of memory or disk, 130 interrupted (a render keeps what
it has).)";

std::vector<std::string> commandNames(const CLI::App& root) {
  std::vector<std::string> names;
  for (const CLI::App* command : root.get_subcommands(nullptr)) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> optionNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

const CLI::App& parsedApp(const CLI::App& root) {
  const std::vector<CLI::App*> parsed = root.get_subcommands();
  return parsed.empty() ? root : *parsed.front();
}

std::string helpHint(const CLI::App& app) {
  return app.get_parent() == nullptr ? "see 'nephroid --help'"
                                     : fmt::format("see 'nephroid {} --help'", app.get_name());
}

/// An argument that nothing took: a slip of an option or of a command.
std::string describeExtra(const CLI::App& root, const std::string& argument) {
  const CLI::App& app = parsedApp(root);
  const bool is_option = argument.starts_with("-");
  const bool is_command = &app == &root && !is_option;
  const std::string name = argument.substr(0, argument.find('='));
  const std::string near = suggestName(name, is_command ? commandNames(root) : optionNames(app));
  const char* kind = is_option ? "unknown option" : is_command ? "unknown command" : "unexpected argument";
  return fmt::format("{} '{}'{}; {}", kind, argument, near.empty() ? "" : fmt::format(", did you mean '{}'?", near),
                     helpHint(app));
}

ExitCode runCommandLine(CLI::App& root, const std::vector<Command>& commands, int argc, char** argv) {
  try {
    root.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    writeStdout(formatHelp(parsedApp(root)));
    return ExitCode::kDone;
  } catch (const CLI::CallForVersion&) {
    writeStdout(fmt::format("nephroid {}\n", version()));
    return ExitCode::kDone;
  } catch (const CLI::ExtrasError& error) {
    const std::vector<std::string> extras = root.remaining(true);
    if (extras.empty()) throw UsageError(error.what());
    throw UsageError(describeExtra(root, extras.front()));
  } catch (const CLI::ParseError& error) {
    throw UsageError(fmt::format("{}; {}", toOneLine(error.what()), helpHint(parsedApp(root))));
  }
  for (const Command& command : commands)
    if (command.app->parsed()) return command.run();
  throw UsageError("no command given; try 'nephroid render builtin:ring -o ring.png', or see 'nephroid --help'");
}

ExitCode runProgram(int argc, char** argv) {
  CLI::App root(kDescription, "nephroid");
  root.footer(kFooter);
  root.set_help_flag("-h,--help", "Print this help.");
  root.set_version_flag("--version", std::string(version()), "Print the version.");
  const std::vector<Command> commands{addRenderCommand(root),  addCompareCommand(root),    addBenchCommand(root),
                                      addInfoCommand(root),    addScenesCommand(root),     addTechniquesCommand(root),
                                      addDevicesCommand(root), addCompletionCommand(root), addManualCommand(root),
                                      addHelpCommand(root)};
  if (answerHelp(root, {argv, static_cast<std::size_t>(argc)})) return ExitCode::kDone;
  return runCommandLine(root, commands, argc, argv);
}

ExitCode reportError(std::string_view text, ExitCode code) {
  writeStderr(fmt::format("error: {}", toOneLine(text)));
  return code;
}

/// Everything that can be thrown, as one line and an exit code.
ExitCode runGuarded(int argc, char** argv) {
  try {
    return runProgram(argc, argv);
  } catch (const InternalError& error) {
    return reportError(fmt::format("internal error: {}; please report it", error.what()), ExitCode::kInternal);
  } catch (const Error& error) {
    return reportError(error.what(), error.exitCode());
  } catch (const std::bad_alloc&) {
    return reportError("out of memory; lower --size, --photons, the number of --aov layers or the scene's segments",
                       ExitCode::kNoResource);
  } catch (const std::exception& error) {
    return reportError(fmt::format("internal error: {}; please report it", error.what()), ExitCode::kInternal);
  }
}

}  // namespace
}  // namespace nephroid::cli

int main(int argc, char** argv) {
  nephroid::cli::installSignalHandlers();
  return static_cast<int>(nephroid::cli::runGuarded(argc, argv));
}
