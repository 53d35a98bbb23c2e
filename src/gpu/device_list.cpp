#include "gpu/device_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>

#include "gpu/instance.h"
#include "gpu/requirements.h"
#include "nephroid/error.h"

namespace nephroid::gpu {
namespace {

const char* nameOf(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "CPU";
    default:
      return "other";
  }
}

std::string formatVersion(std::uint32_t version) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                     VK_API_VERSION_PATCH(version));
}

/// A family that draws and computes; every device that draws has one.
std::optional<std::uint32_t> findQueueFamily(const InstanceApi& api, VkPhysicalDevice device, bool& timestamps) {
  std::uint32_t count = 0;
  api.GetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  api.GetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  for (std::uint32_t i = 0; i < count; ++i) {
    constexpr VkQueueFlags kWanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    if ((families[i].queueFlags & kWanted) != kWanted) continue;
    timestamps = families[i].timestampValidBits > 0;
    return i;
  }
  return std::nullopt;
}

std::uint64_t largestLocalHeap(const InstanceApi& api, VkPhysicalDevice device) {
  VkPhysicalDeviceMemoryProperties memory;
  api.GetPhysicalDeviceMemoryProperties(device, &memory);
  std::uint64_t largest = 0;
  for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i)
    if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
      largest = std::max<std::uint64_t>(largest, memory.memoryHeaps[i].size);
  return largest;
}

std::vector<VkExtensionProperties> listExtensions(const InstanceApi& api, VkPhysicalDevice device) {
  std::uint32_t count = 0;
  check(api.EnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr), "listing extensions of a device");
  std::vector<VkExtensionProperties> extensions(count);
  check(api.EnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data()),
        "listing extensions of a device");
  return extensions;
}

/// Larger is better.
int rankOf(const DeviceInfo& device) {
  if (device.kind == "discrete GPU") return 3;
  if (device.kind == "integrated GPU") return 2;
  return device.kind == "CPU" ? 0 : 1;
}

}  // namespace

DeviceInfo describeDevice(const InstanceApi& api, VkPhysicalDevice device) {
  DeviceInfo info;
  info.handle = device;
  VkPhysicalDeviceProperties properties;
  api.GetPhysicalDeviceProperties(device, &properties);
  info.name = properties.deviceName;
  info.kind = nameOf(properties.deviceType);
  info.api_version = formatVersion(properties.apiVersion);
  info.memory_bytes = largestLocalHeap(api, device);
  if (properties.apiVersion < VK_API_VERSION_1_3) {
    // The structures below do not exist for it.
    info.missing.push_back(fmt::format("Vulkan 1.3 (has {})", info.api_version));
    return info;
  }
  VkPhysicalDeviceDriverProperties driver{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 more{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
  api.GetPhysicalDeviceProperties2(device, &more);
  info.driver = fmt::format("{}{}{}", driver.driverName, driver.driverInfo[0] ? ", " : "", driver.driverInfo);

  const std::vector<VkExtensionProperties> extensions = listExtensions(api, device);
  const auto has = [&](const char* name) {
    return std::any_of(extensions.begin(), extensions.end(),
                       [&](const VkExtensionProperties& e) { return std::strcmp(e.extensionName, name) == 0; });
  };
  info.ray_tracing_pipeline = has(VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME);
  Features available;
  api.GetPhysicalDeviceFeatures2(device, available.chain());
  info.missing = available.lacking();
  info.float_atomics = has(VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME) && available.floatAtomics();
  info.int64_atomics = available.int64Atomics();
  for (const char* extension : neededExtensions())
    if (!has(extension)) info.missing.emplace_back(extension);
  bool timestamps = false;
  if (const auto family = findQueueFamily(api, device, timestamps))
    info.queue_family = *family;
  else
    info.missing.emplace_back("a queue for graphics and compute");
  info.timestamp_period_ns = timestamps ? properties.limits.timestampPeriod : 0.0F;
  return info;
}

std::vector<DeviceInfo> listDevices(const Instance& instance) {
  const InstanceApi& api = instance.api();
  std::uint32_t count = 0;
  check(api.EnumeratePhysicalDevices(instance.handle(), &count, nullptr), "listing Vulkan devices");
  std::vector<VkPhysicalDevice> handles(count);
  check(api.EnumeratePhysicalDevices(instance.handle(), &count, handles.data()), "listing Vulkan devices");
  std::vector<DeviceInfo> devices;
  for (VkPhysicalDevice handle : handles) devices.push_back(describeDevice(api, handle));
  return devices;
}

DeviceChoice chooseDevice(const std::vector<DeviceInfo>& devices, std::string_view wanted) {
  if (devices.empty())
    throw DeviceError(
        "Vulkan lists no device: install a driver (mesa-vulkan-drivers draws on the CPU), or use --device cpu");
  if (wanted != "auto") {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    if (error != std::errc{} || end != wanted.data() + wanted.size())
      throw UsageError(fmt::format("--device {}: expected auto, cpu or the number of a device", wanted));
    if (index >= devices.size())
      throw DeviceError(fmt::format("--device {}: there are {} devices, counted from 0; `nephroid devices` lists them",
                                    wanted, devices.size()));
    if (!devices[index].usable())
      throw DeviceError(fmt::format("--device {}: {} lacks {}", wanted, devices[index].name,
                                    fmt::join(devices[index].missing, ", ")));
    return {index, "asked for"};
  }
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (!devices[i].usable()) continue;
    const auto rank = [&](std::size_t k) { return std::pair(rankOf(devices[k]), devices[k].memory_bytes); };
    if (!best || rank(i) > rank(*best)) best = i;
  }
  if (!best) {
    std::string lacking;
    for (const DeviceInfo& device : devices)
      lacking +=
          fmt::format("{}{} lacks {}", lacking.empty() ? "" : "; ", device.name, fmt::join(device.missing, ", "));
    throw DeviceError(fmt::format("no usable Vulkan device: {}; use --device cpu", lacking));
  }
  const std::string& kind = devices[*best].kind;
  const auto same =
      std::count_if(devices.begin(), devices.end(), [&](const DeviceInfo& d) { return d.usable() && d.kind == kind; });
  return {*best, same > 1        ? fmt::format("the {} with most memory of {}", kind, same)
                 : kind == "CPU" ? std::string("no GPU is usable; Vulkan on the CPU")
                                 : fmt::format("the only {}", kind)};
}

}  // namespace nephroid::gpu
