#include <fmt/format.h>

#include <algorithm>

#include "nephroid/error.h"
#include "techniques/layers.h"
#include "techniques/reference/reference.h"
#include "techniques/technique.h"
#ifdef NEPHROID_VULKAN
#include "gpu/device_survey.h"
#include "techniques/caustic_map/caustic_map.h"
#include "techniques/none/none.h"
#endif

namespace nephroid {
#ifdef NEPHROID_VULKAN
namespace {

/// What only progressive techniques give.
bool wantsConvergence(const RenderSettings& wanted) {
  return wanted.target_error > 0.0 || !wanted.checkpoint.path.empty() ||
         std::any_of(wanted.layers.begin(), wanted.layers.end(), isEstimate);
}

}  // namespace
#endif

std::span<const Technique> techniques() {
  // One line a technique: an explicit list, because static registration is dropped by linkers of static libraries.
  static const Technique list[] = {
      makeReferenceTechnique(),
#ifdef NEPHROID_VULKAN
      makeCausticMapTechnique(),
      makeNoneTechnique(),
#endif
  };
  return list;
}

const Technique& findTechnique(std::string_view name) {
  std::vector<std::string> names;
  for (const Technique& technique : techniques()) {
    if (technique.name == name) return technique;
    names.push_back(technique.name);
  }
  throw UsageError(fmt::format("no technique '{}'; there are: {}", name, fmt::join(names, ", ")));
}

const Technique& chooseTechnique(std::string_view name, const RenderSettings& wanted) {
  if (name != kAutoTechnique) return findTechnique(name);
#ifdef NEPHROID_VULKAN
  // Who names a device wants it, and is told if it is not there.
  const auto has_device = [&] {
    return wanted.device == "auto" ? gpu::surveyDevices().auto_device.has_value() : wanted.device != "cpu";
  };
  if (!wantsConvergence(wanted) && has_device()) return findTechnique("caustic-map");
#else
  static_cast<void>(wanted);
#endif
  return findTechnique("reference");
}

bool takesDevice(const Technique& technique, std::string_view device) {
  return device == "auto" || (device == "cpu") != technique.on_vulkan;
}

void checkDevice(const Technique& technique, std::string_view device) {
  const bool is_number =
      !device.empty() && std::all_of(device.begin(), device.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (device != "auto" && device != "cpu" && !is_number)
    throw UsageError(fmt::format("--device {}: expected auto, cpu or the number of a device", device));
  if (takesDevice(technique, device)) return;
  throw UsageError(
      technique.on_vulkan
          ? fmt::format("--device {}: technique {} needs a Vulkan device; use --device auto or --technique reference",
                        device, technique.name)
          : fmt::format("--device {}: technique {} computes on the CPU; use --device auto, or another technique",
                        device, technique.name));
}

void checkProgressive(const Technique& technique, const RenderSettings& settings) {
  if (technique.is_progressive) return;
  const auto refuse = [&](std::string_view option, std::string_view reason) {
    throw UsageError(fmt::format("{}: technique {} {}; use --technique reference", option, technique.name, reason));
  };
  if (settings.target_error > 0.0) refuse("--target-error", "does not estimate its error");
  if (!settings.checkpoint.path.empty()) refuse("--checkpoint", "does not go on where it left off");
}

}  // namespace nephroid
