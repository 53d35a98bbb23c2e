// The options that choose a technique and its budget, shared by `render` and `bench`.
#pragma once

#include <string>
#include <vector>

#include "app/cli/options.h"
#include "techniques/technique.h"

namespace nephroid::cli {

struct TechniqueOptions {
  std::string name{kAutoTechnique};
  Size size{1024, 768};
  std::uint64_t photons = 0, samples = 0;
  double seconds = 0;
  std::uint64_t seed = 0;
  int threads = 0;
  std::string device = "auto";
  std::vector<std::string> parameters;  ///< "key=value"
};

/// What --help says of the defaults that depend on the subcommand.
struct TechniqueDefaults {
  std::string name, size, photons, samples;
};

/// The values that `options` have.
TechniqueDefaults describeDefaults(const TechniqueOptions& options);

/// @param name  receives --technique
void addTechniqueOptions(CLI::App& app, TechniqueOptions& options, std::string& name,
                         const TechniqueDefaults& defaults);

/// Everything but the layers.
/// @throws UsageError for an unknown technique, parameter or value, or a device that the technique does not take
RenderSettings makeSettings(const TechniqueOptions& options);

}  // namespace nephroid::cli
