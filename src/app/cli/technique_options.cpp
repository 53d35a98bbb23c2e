#include "app/cli/technique_options.h"

#include <fmt/format.h>

#include "nephroid/error.h"

namespace nephroid::cli {
namespace {

std::string joinTechniqueNames() {
  std::vector<std::string> names{std::string(kAutoTechnique)};
  for (const Technique& technique : techniques()) names.push_back(technique.name);
  return fmt::format("{}", fmt::join(names, "|"));
}

std::string describeBudget(std::uint64_t budget) {
  return budget == 0 ? "chosen by the technique" : fmt::format("{}", budget);
}

}  // namespace

TechniqueDefaults describeDefaults(const TechniqueOptions& options) {
  return {options.name, fmt::format("{}x{}", options.size.width, options.size.height), describeBudget(options.photons),
          describeBudget(options.samples)};
}

void addTechniqueOptions(CLI::App& app, TechniqueOptions& options, std::string& name,
                         const TechniqueDefaults& defaults) {
  beginGroup(app, "Technique");
  addValue(app, "--technique", name, "NAME",
           {"How to draw; 'nephroid techniques' describes each. auto is caustic-map where there is a Vulkan device and "
            "--device is not cpu; else, and for what only it has (--target-error, --checkpoint, layers of errors), "
            "reference.",
            defaults.name, joinTechniqueNames(), ""});
  addList(app, "--set", options.parameters, "KEY=VALUE",
          {"A parameter of the technique; 'nephroid techniques' lists them.", "none", "", ""});
  addValue(app, "--device", options.device, "DEVICE",
           {"What computes: auto is the best Vulkan device where the technique needs one, else the CPU; cpu uses no "
            "Vulkan; N is the number of a Vulkan device, from 0.",
            "auto", "auto|cpu|N", ""});
  beginGroup(app, "Budget");
  addParsed(app, "--size", [&options](const std::string& text) { options.size = parseSize("--size", text); }, "WxH",
            {"Size of the picture.", defaults.size, fmt::format("1x1 to {0}x{0}", kMaxSide), "px"});
  addCount(app, "--photons", options.photons,
           {"Photons emitted, over all lights and bands; 500k, 2M and 1e6 are understood.", defaults.photons,
            "0 to 9e15", "photons"});
  addCount(app, "--samples", options.samples, {"Camera samples.", defaults.samples, "0 to 9e15", "per pixel"});
  addValue(
      app, "--seconds", options.seconds, "S",
      {"Ends a progressive render after this time; the picture then varies between runs.", "none", "0.001 to 1e7", "s"},
      checkNumber(1e-3, 1e7));
  addCount(app, "--seed", options.seed,
           {"Of the random numbers: equal seeds give equal pixels.", "0", "0 to 9e15", ""});
  addValue(app, "--threads", options.threads, "N",
           {"Threads; 0 is all cores. Their number does not change the picture.", "0", "0 to 4096", ""},
           checkNumber(0, 4096));
  endGroup(app);
}

RenderSettings makeSettings(const TechniqueOptions& options) {
  RenderSettings settings;
  settings.width = options.size.width;
  settings.height = options.size.height;
  settings.photons = options.photons;
  settings.samples = options.samples;
  settings.seconds = options.seconds;
  settings.seed = options.seed;
  settings.threads = options.threads;
  settings.device = options.device;
  const Technique& technique = chooseTechnique(options.name, settings);
  checkDevice(technique, options.device);
  settings.params = ParamSet(technique.params);
  for (const std::string& parameter : options.parameters) {
    const std::size_t equals = parameter.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError(fmt::format("--set: '{}' is not KEY=VALUE; 'nephroid techniques' lists the keys", parameter));
    settings.params.set(parameter.substr(0, equals), parameter.substr(equals + 1));
  }
  return settings;
}

}  // namespace nephroid::cli
