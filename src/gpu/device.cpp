#include "gpu/device.h"

#include <fmt/format.h>

#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/file.h"
#include "gpu/requirements.h"
#include "nephroid/error.h"

namespace nephroid::gpu {

Device::Device(const Instance& instance, const DeviceInfo& info) : instance_api_(instance.api()) {
  create(info);
  try {
    api_ = DeviceApi::load(instance_api_.GetDeviceProcAddr, handle_);
    queue_family_ = info.queue_family;
    api_.GetDeviceQueue(handle_, queue_family_, 0, &queue_);
    timestamp_tick_ms_ = static_cast<double>(info.timestamp_period_ns) * 1e-6;
    float_atomics_ = info.float_atomics;
    int64_atomics_ = info.int64_atomics;
    finishCreation(instance_api_, info.handle);
  } catch (...) {
    destroy();
    throw;
  }
}

Device::Device(const ForeignDevice& foreign)
    : instance_api_(InstanceApi::load(foreign.get_instance_proc_addr, foreign.instance)),
      api_(DeviceApi::load(instance_api_.GetDeviceProcAddr, foreign.device)),
      handle_(foreign.device),
      owned_(false),
      queue_(foreign.queue),
      queue_family_(foreign.queue_family),
      int64_atomics_(foreign.int64_atomics) {
  try {
    finishCreation(instance_api_, foreign.physical);
    // Not every queue counts time.
    std::uint32_t count = 0;
    instance_api_.GetPhysicalDeviceQueueFamilyProperties(foreign.physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    instance_api_.GetPhysicalDeviceQueueFamilyProperties(foreign.physical, &count, families.data());
    if (queue_family_ < count && families[queue_family_].timestampValidBits > 0)
      timestamp_tick_ms_ = static_cast<double>(properties_.limits.timestampPeriod) * 1e-6;
  } catch (...) {
    destroy();
    throw;
  }
}

Device::~Device() { destroy(); }

void Device::create(const DeviceInfo& info) {
  Features available, wanted;
  instance_api_.GetPhysicalDeviceFeatures2(info.handle, available.chain());
  wanted.requireNeeded();
  std::vector<const char*> extensions = neededExtensions();
  wanted.takeWelcome(available);
  if (info.float_atomics) extensions.push_back(VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME);
  const float priority = 1.0F;
  const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                      .queueFamilyIndex = info.queue_family,
                                      .queueCount = 1,
                                      .pQueuePriorities = &priority};
  const VkDeviceCreateInfo create{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                  .pNext = info.float_atomics ? wanted.chain() : wanted.chainWithoutExtensions(),
                                  .queueCreateInfoCount = 1,
                                  .pQueueCreateInfos = &queue,
                                  .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                                  .ppEnabledExtensionNames = extensions.data()};
  check(instance_api_.CreateDevice(info.handle, &create, nullptr, &handle_),
        fmt::format("opening the device '{}'", info.name));
}

void Device::finishCreation(const InstanceApi& instance, VkPhysicalDevice physical) {
  physical_ = physical;
  instance.GetPhysicalDeviceProperties(physical, &properties_);
  memory_ = std::make_unique<MemoryAllocator>(instance, physical, api_, handle_);
  const VkSemaphoreTypeCreateInfo timeline{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                           .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
  const VkSemaphoreCreateInfo create{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &timeline};
  check(api_.CreateSemaphore(handle_, &create, nullptr, &timeline_), "creating a semaphore");
  makePipelineCache(nullptr, 0);
}

VkFormatFeatureFlags Device::featuresOf(VkFormat format) const {
  VkFormatProperties properties;
  instance_api_.GetPhysicalDeviceFormatProperties(physical_, format, &properties);
  return properties.optimalTilingFeatures;
}

void Device::destroy() {
  if (!handle_) return;
  if (api_.DeviceWaitIdle && timeline_) {
    // A lost device is destroyed like any other; nothing can be told to anyone here.
    static_cast<void>(api_.DeviceWaitIdle(handle_));
    for (Retired& retired : retired_) retired.destroy();
    retired_.clear();
  }
  memory_.reset();
  if (pipeline_cache_) api_.DestroyPipelineCache(handle_, pipeline_cache_, nullptr);
  if (timeline_) api_.DestroySemaphore(handle_, timeline_, nullptr);
  if (owned_ && api_.DestroyDevice) api_.DestroyDevice(handle_, nullptr);
  handle_ = VK_NULL_HANDLE;
}

void Device::setName(VkObjectType type, std::uint64_t handle, std::string_view name) const {
  if (!instance_api_.SetDebugUtilsObjectNameEXT) return;
  const std::string text(name);
  const VkDebugUtilsObjectNameInfoEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                           .objectType = type,
                                           .objectHandle = handle,
                                           .pObjectName = text.c_str()};
  check(instance_api_.SetDebugUtilsObjectNameEXT(handle_, &info), "naming an object");
}

void Device::beginLabel(VkCommandBuffer commands, const char* name) const {
  if (!instance_api_.CmdBeginDebugUtilsLabelEXT) return;
  const VkDebugUtilsLabelEXT label{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = name};
  instance_api_.CmdBeginDebugUtilsLabelEXT(commands, &label);
}

void Device::endLabel(VkCommandBuffer commands) const {
  if (instance_api_.CmdEndDebugUtilsLabelEXT) instance_api_.CmdEndDebugUtilsLabelEXT(commands);
}

std::uint64_t Device::submit(VkCommandBuffer commands) {
  const VkCommandBufferSubmitInfo buffer{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                         .commandBuffer = commands};
  const VkSemaphoreSubmitInfo signal{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                     .semaphore = timeline_,
                                     .value = submitted_ + 1,
                                     .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
  const VkSubmitInfo2 info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                           .commandBufferInfoCount = 1,
                           .pCommandBufferInfos = &buffer,
                           .signalSemaphoreInfoCount = 1,
                           .pSignalSemaphoreInfos = &signal};
  check(api_.QueueSubmit2(queue_, 1, &info, VK_NULL_HANDLE), "submitting a frame");
  ++submitted_;
  collect();
  return submitted_;
}

void Device::wait(std::uint64_t number) {
  const VkSemaphoreWaitInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                 .semaphoreCount = 1,
                                 .pSemaphores = &timeline_,
                                 .pValues = &number};
  check(api_.WaitSemaphores(handle_, &info, ~std::uint64_t{0}), "waiting for a frame");
  collect();
}

void Device::retire(std::function<void()> destroy) {
  retired_.push_back({submitted_, std::move(destroy)});
  collect();
}

void Device::collect() {
  if (retired_.empty()) return;
  std::uint64_t done = 0;
  // Called by destructors: a lost device is reported by the next submission.
  if (api_.GetSemaphoreCounterValue(handle_, timeline_, &done) != VK_SUCCESS) return;
  while (!retired_.empty() && retired_.front().after <= done) {
    retired_.front().destroy();
    retired_.pop_front();
  }
}

void Device::makePipelineCache(const void* data, std::size_t size) {
  const VkPipelineCacheCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO, .initialDataSize = size, .pInitialData = data};
  VkPipelineCache made = VK_NULL_HANDLE;
  check(api_.CreatePipelineCache(handle_, &info, nullptr, &made), "creating a pipeline cache");
  if (pipeline_cache_) api_.DestroyPipelineCache(handle_, pipeline_cache_, nullptr);
  pipeline_cache_ = made;
}

void Device::readPipelineCache(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return;
  const std::vector<std::byte> data = readFile(file);
  // The driver checks the header (vendor, device, version); a cache of another driver is left out.
  makePipelineCache(data.data(), data.size());
}

void Device::writePipelineCache(const std::filesystem::path& file) const {
  std::size_t size = 0;
  if (api_.GetPipelineCacheData(handle_, pipeline_cache_, &size, nullptr) != VK_SUCCESS) return;
  std::vector<std::byte> data(size);
  if (api_.GetPipelineCacheData(handle_, pipeline_cache_, &size, data.data()) != VK_SUCCESS) return;
  data.resize(size);
  try {
    std::filesystem::create_directories(file.parent_path());
    writeFileAtomically(file, data);
  } catch (const Error&) {
  } catch (const std::filesystem::filesystem_error&) {
  }
}

}  // namespace nephroid::gpu
