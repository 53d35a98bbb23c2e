// Vulkan's functions, in tables that belong to an instance or a device.
//
// The loader is opened at run time, so a program starts where there is none. No global function pointers: those of a
// meta-loader carry the names of the functions themselves, and would collide with a program that links libvulkan.
#pragma once

#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <vulkan/vulkan.h>

#include <string_view>

namespace nephroid::gpu {

// Functions that exist before there is an instance.
#define NEPHROID_VK_GLOBAL_FUNCTIONS(X) \
  X(CreateInstance)                     \
  X(EnumerateInstanceLayerProperties)   \
  X(EnumerateInstanceExtensionProperties)

#define NEPHROID_VK_INSTANCE_FUNCTIONS(X) \
  X(CreateDevice)                         \
  X(DestroyInstance)                      \
  X(EnumerateDeviceExtensionProperties)   \
  X(EnumeratePhysicalDevices)             \
  X(GetDeviceProcAddr)                    \
  X(GetPhysicalDeviceFeatures2)           \
  X(GetPhysicalDeviceFormatProperties)    \
  X(GetPhysicalDeviceMemoryProperties)    \
  X(GetPhysicalDeviceProperties)          \
  X(GetPhysicalDeviceProperties2)         \
  X(GetPhysicalDeviceQueueFamilyProperties)

// Of VK_EXT_debug_utils, loaded where the instance has it; null elsewhere.
#define NEPHROID_VK_DEBUG_FUNCTIONS(X) \
  X(CreateDebugUtilsMessengerEXT)      \
  X(DestroyDebugUtilsMessengerEXT)     \
  X(CmdBeginDebugUtilsLabelEXT)        \
  X(CmdEndDebugUtilsLabelEXT)          \
  X(SetDebugUtilsObjectNameEXT)

#define NEPHROID_VK_DEVICE_FUNCTIONS(X) \
  X(AllocateCommandBuffers)             \
  X(AllocateMemory)                     \
  X(BeginCommandBuffer)                 \
  X(BindBufferMemory)                   \
  X(BindImageMemory)                    \
  X(CmdBeginRendering)                  \
  X(CmdBindIndexBuffer)                 \
  X(CmdBindPipeline)                    \
  X(CmdBindVertexBuffers)               \
  X(CmdBlitImage)                       \
  X(CmdClearColorImage)                 \
  X(CmdCopyBuffer)                      \
  X(CmdCopyBufferToImage)               \
  X(CmdCopyImageToBuffer)               \
  X(CmdDispatch)                        \
  X(CmdDispatchIndirect)                \
  X(CmdDraw)                            \
  X(CmdDrawIndexed)                     \
  X(CmdEndRendering)                    \
  X(CmdFillBuffer)                      \
  X(CmdPipelineBarrier2)                \
  X(CmdPushConstants)                   \
  X(CmdPushDescriptorSetKHR)            \
  X(CmdSetScissor)                      \
  X(CmdSetViewport)                     \
  X(CmdWriteTimestamp2)                 \
  X(CreateBuffer)                       \
  X(CreateBufferView)                   \
  X(CreateCommandPool)                  \
  X(CreateComputePipelines)             \
  X(CreateDescriptorSetLayout)          \
  X(CreateGraphicsPipelines)            \
  X(CreateImage)                        \
  X(CreateImageView)                    \
  X(CreatePipelineCache)                \
  X(CreatePipelineLayout)               \
  X(CreateQueryPool)                    \
  X(CreateSampler)                      \
  X(CreateSemaphore)                    \
  X(CreateShaderModule)                 \
  X(DestroyBuffer)                      \
  X(DestroyBufferView)                  \
  X(DestroyCommandPool)                 \
  X(DestroyDescriptorSetLayout)         \
  X(DestroyDevice)                      \
  X(DestroyImage)                       \
  X(DestroyImageView)                   \
  X(DestroyPipeline)                    \
  X(DestroyPipelineCache)               \
  X(DestroyPipelineLayout)              \
  X(DestroyQueryPool)                   \
  X(DestroySampler)                     \
  X(DestroySemaphore)                   \
  X(DestroyShaderModule)                \
  X(DeviceWaitIdle)                     \
  X(EndCommandBuffer)                   \
  X(FreeCommandBuffers)                 \
  X(FreeMemory)                         \
  X(GetBufferMemoryRequirements)        \
  X(GetDeviceQueue)                     \
  X(GetImageMemoryRequirements)         \
  X(GetPipelineCacheData)               \
  X(GetQueryPoolResults)                \
  X(GetSemaphoreCounterValue)           \
  X(MapMemory)                          \
  X(QueueSubmit2)                       \
  X(ResetQueryPool)                     \
  X(UnmapMemory)                        \
  X(WaitSemaphores)

#define NEPHROID_VK_MEMBER(name) PFN_vk##name name = nullptr;

/// What an application needs to begin. Does not own the loader, which stays open until the program ends.
struct GlobalApi {
  PFN_vkGetInstanceProcAddr GetInstanceProcAddr = nullptr;
  NEPHROID_VK_GLOBAL_FUNCTIONS(NEPHROID_VK_MEMBER)

  /// Opens the system's Vulkan loader.
  /// @throws DeviceError if there is none
  static GlobalApi open();
};

struct InstanceApi {
  NEPHROID_VK_INSTANCE_FUNCTIONS(NEPHROID_VK_MEMBER)
  NEPHROID_VK_DEBUG_FUNCTIONS(NEPHROID_VK_MEMBER)

  /// @throws DeviceError if the loader lacks a function of Vulkan 1.3
  static InstanceApi load(PFN_vkGetInstanceProcAddr get, VkInstance instance);
};

struct DeviceApi {
  NEPHROID_VK_DEVICE_FUNCTIONS(NEPHROID_VK_MEMBER)

  /// @throws DeviceError if the driver lacks a function that was promised with the device
  static DeviceApi load(PFN_vkGetDeviceProcAddr get, VkDevice device);
};

#undef NEPHROID_VK_MEMBER

/// Throws unless `result` is a success.
/// @param what  what was being done, for the message: "allocating 64 MiB for 'g-buffer'"
/// @throws ResourceError out of memory (says what to lower), DeviceError device lost, InternalError anything else
void check(VkResult result, std::string_view what);

}  // namespace nephroid::gpu
