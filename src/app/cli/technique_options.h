// The options that choose a technique and its budget, shared by `render` and `bench`.
#pragma once

#include <string>
#include <vector>

#include "app/cli/options.h"
#include "techniques/technique.h"

namespace nephroid::cli {

struct TechniqueOptions {
  std::string name = "reference";
  Size size{1024, 768};
  std::uint64_t photons = 0, samples = 0;
  double seconds = 0;
  std::uint64_t seed = 0;
  int threads = 0;
  std::string device = "auto";
  std::vector<std::string> parameters;  ///< "key=value"
};

/// @param options       their current values are the defaults that --help tells
/// @param name          receives --technique
/// @param default_name  what --help says of the default
void addTechniqueOptions(CLI::App& app, TechniqueOptions& options, std::string& name, const std::string& default_name);

/// Everything but the layers.
/// @throws UsageError for an unknown technique, parameter or value, or a device that the technique does not take
RenderSettings makeSettings(const TechniqueOptions& options);

}  // namespace nephroid::cli
