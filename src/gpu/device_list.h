// Which Vulkan devices there are, what each lacks, and which one `auto` takes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

struct VkPhysicalDevice_T;  // by name, so that whoever only reads a list needs no Vulkan headers

namespace nephroid::gpu {

class Instance;
struct InstanceApi;

struct DeviceInfo {
  VkPhysicalDevice_T* handle = nullptr;  ///< a VkPhysicalDevice; valid as long as its instance
  std::string name;
  std::string kind;                  ///< "discrete GPU", "integrated GPU", "virtual GPU", "CPU", "other"
  std::string driver;                ///< name and version as the driver says them
  std::string api_version;           ///< "1.3.230"
  std::uint64_t memory_bytes = 0;    ///< of the largest heap that is local to the device
  std::vector<std::string> missing;  ///< what nephroid needs and this device has not; empty: usable
  bool ray_tracing_pipeline = false;
  bool float_atomics = false;      ///< adds to 32-bit floats in buffers and images
  bool int64_atomics = false;      ///< atomics on 64-bit integers in buffers
  std::uint32_t queue_family = 0;  ///< of graphics and compute together
  float timestamp_period_ns = 0;   ///< of one tick; 0: no timestamps

  bool usable() const { return missing.empty(); }
};

/// One of an instance that need not be ours.
DeviceInfo describeDevice(const InstanceApi& api, VkPhysicalDevice_T* device);

/// All devices, in the order in which Vulkan lists them: `--device N` counts from 0.
std::vector<DeviceInfo> listDevices(const Instance& instance);

struct DeviceChoice {
  std::size_t index = 0;
  std::string reason;  ///< one line: why this one
};

/// @param wanted  "auto" (the best discrete GPU, then integrated, then any other that is usable) or an index
/// @throws DeviceError if none fits, UsageError if `wanted` is neither
DeviceChoice chooseDevice(const std::vector<DeviceInfo>& devices, std::string_view wanted);

}  // namespace nephroid::gpu
