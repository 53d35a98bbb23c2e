// The subcommands of `nephroid`, one file each; main.cpp lists them.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

#include "nephroid/error.h"

namespace nephroid::cli {

/// A subcommand: its declaration (options, help) and what it does once its options are parsed.
struct Command {
  CLI::App* app = nullptr;
  std::function<ExitCode()> run;
};

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
