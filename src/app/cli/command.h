// The subcommands of `nephroid`, one file each; main.cpp lists them.
#pragma once

#include <functional>
#include <string>

#include "app/cli/options.h"
#include "nephroid/error.h"

namespace nephroid::cli {

/// A subcommand: its declaration (options, help) and what it does once its options are parsed.
struct Command {
  CLI::App* app = nullptr;
  std::function<ExitCode()> run;
};

/// A subcommand, which has no options yet. @param footer  below the options in its help; without one, the program's
CLI::App* addCommand(CLI::App& root, const std::string& name, const std::string& description,
                     const std::string& footer = "");

Command addRenderCommand(CLI::App& root);
Command addCompareCommand(CLI::App& root);
Command addBenchCommand(CLI::App& root);
Command addInfoCommand(CLI::App& root);
Command addScenesCommand(CLI::App& root);
Command addTechniquesCommand(CLI::App& root);
Command addDevicesCommand(CLI::App& root);
Command addCompletionCommand(CLI::App& root);
Command addManualCommand(CLI::App& root);
Command addHelpCommand(CLI::App& root);

}  // namespace nephroid::cli
