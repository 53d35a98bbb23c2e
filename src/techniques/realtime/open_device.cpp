#include "techniques/realtime/open_device.h"

#include <fmt/format.h>

#include <cctype>
#include <cstdlib>
#include <string_view>

#include "nephroid/error.h"

namespace nephroid {
namespace {

/// As the XDG base directory specification says; nothing where no home is known.
std::optional<std::filesystem::path> findCacheFolder() {
  // Relative paths are to be ignored, by that specification.
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && std::filesystem::path(cache).is_absolute())
    return std::filesystem::path(cache) / "nephroid";
  if (const char* home = std::getenv("HOME"); home && std::filesystem::path(home).is_absolute())
    return std::filesystem::path(home) / ".cache" / "nephroid";
  return std::nullopt;
}

/// One file a device. Another version of its driver refuses the contents and writes its own over them.
std::optional<std::filesystem::path> findPipelineCache(std::string_view device_name) {
  const std::optional<std::filesystem::path> folder = findCacheFolder();
  if (!folder) return std::nullopt;
  std::string name;
  for (const char c : device_name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte))
      name += static_cast<char>(std::tolower(byte));
    else if (!name.empty() && name.back() != '-')
      name += '-';
  }
  while (name.ends_with('-')) name.pop_back();
  return *folder / fmt::format("pipelines-{}.bin", name);
}

bool wantsValidation() {
  const char* value = std::getenv("NEPHROID_VALIDATION");
  return value && std::string_view(value) == "1";
}

}  // namespace

OpenDevice::OpenDevice(const std::string& wanted)
    : instance_({.validation = wantsValidation()}),
      infos_(gpu::listDevices(instance_)),
      device_(instance_, infos_[gpu::chooseDevice(infos_, wanted).index]),
      cache_(findPipelineCache(device_.name())) {
  if (!cache_) return;
  try {
    device_.readPipelineCache(*cache_);
  } catch (const Error&) {
    // It only saves time.
  }
}

void OpenDevice::keepPipelines() const {
  if (cache_) device_.writePipelineCache(*cache_);
}

void OpenDevice::checkValidation() const {
  const std::vector<std::string> messages = instance_.validationMessages();
  if (!messages.empty())
    throw InternalError(fmt::format("{} messages of Vulkan validation, first: {}", messages.size(), messages[0]));
}

}  // namespace nephroid
