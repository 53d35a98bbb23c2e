// The Vulkan device of one render by the command line or `nephroid::render`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gpu/device.h"

namespace nephroid {

/// An instance, a device, and pipelines that earlier runs compiled for it. With NEPHROID_VALIDATION=1 in the
/// environment the validation layer looks on.
class OpenDevice {
 public:
  /// @param wanted  RenderSettings::device
  /// @throws DeviceError, UsageError
  explicit OpenDevice(const std::string& wanted);

  gpu::Device& device() { return device_; }
  /// Writes what was compiled for later runs.
  void keepPipelines() const;
  /// @throws InternalError with the first thing that the validation layer said, if it was asked to look
  void checkValidation() const;

 private:
  gpu::Instance instance_;
  std::vector<gpu::DeviceInfo> infos_;
  gpu::Device device_;
  std::optional<std::filesystem::path> cache_;
};

}  // namespace nephroid
