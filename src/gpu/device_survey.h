// What there is to compute on, in words; part of every build, also of those without Vulkan.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu/device_list.h"

namespace nephroid::gpu {

struct DeviceSurvey {
  std::vector<DeviceInfo> devices;         ///< without their handles
  std::optional<std::size_t> auto_device;  ///< the one that `--device auto` takes; none: only the CPU is left
  std::string reason;                      ///< one line: why that one, or why none and what to do
};

/// Looks at all Vulkan devices. That there is none, no driver, no loader or no Vulkan in this build is an answer, not a
/// failure.
DeviceSurvey surveyDevices();

}  // namespace nephroid::gpu
