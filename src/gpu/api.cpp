#include "gpu/api.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "nephroid/error.h"

namespace nephroid::gpu {
namespace {

template <class Function>
Function require(PFN_vkVoidFunction function, const char* name) {
  if (!function) throw DeviceError(fmt::format("the Vulkan driver has no {}; Vulkan 1.3 is needed", name));
  return reinterpret_cast<Function>(function);
}

}  // namespace

GlobalApi GlobalApi::open() {
  // Never closed: drivers leave threads and exit handlers behind that would run into unmapped code.
  void* library = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
  if (!library)
    throw DeviceError(
        "no Vulkan loader (libvulkan.so.1): install libvulkan1 and a driver such as mesa-vulkan-drivers, or use "
        "--device cpu");
  GlobalApi api;
  api.GetInstanceProcAddr = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vkGetInstanceProcAddr"));
  if (!api.GetInstanceProcAddr)
    throw DeviceError("libvulkan.so.1 is no Vulkan loader: it has no vkGetInstanceProcAddr");
#define NEPHROID_VK_LOAD(name) \
  api.name = require<PFN_vk##name>(api.GetInstanceProcAddr(VK_NULL_HANDLE, "vk" #name), "vk" #name);
  NEPHROID_VK_GLOBAL_FUNCTIONS(NEPHROID_VK_LOAD)
#undef NEPHROID_VK_LOAD
  return api;
}

InstanceApi InstanceApi::load(PFN_vkGetInstanceProcAddr get, VkInstance instance) {
  InstanceApi api;
#define NEPHROID_VK_LOAD(name) api.name = require<PFN_vk##name>(get(instance, "vk" #name), "vk" #name);
  NEPHROID_VK_INSTANCE_FUNCTIONS(NEPHROID_VK_LOAD)
#undef NEPHROID_VK_LOAD
#define NEPHROID_VK_LOAD(name) api.name = reinterpret_cast<PFN_vk##name>(get(instance, "vk" #name));
  NEPHROID_VK_DEBUG_FUNCTIONS(NEPHROID_VK_LOAD)
#undef NEPHROID_VK_LOAD
  return api;
}

DeviceApi DeviceApi::load(PFN_vkGetDeviceProcAddr get, VkDevice device) {
  DeviceApi api;
#define NEPHROID_VK_LOAD(name) api.name = require<PFN_vk##name>(get(device, "vk" #name), "vk" #name);
  NEPHROID_VK_DEVICE_FUNCTIONS(NEPHROID_VK_LOAD)
#undef NEPHROID_VK_LOAD
  return api;
}

void check(VkResult result, std::string_view what) {
  if (result >= 0) return;
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_TOO_MANY_OBJECTS:
      throw ResourceError(
          fmt::format("out of memory on the Vulkan device while {}; lower --size, the sizes of maps (--set) or the "
                      "scene's textures",
                      what));
    case VK_ERROR_DEVICE_LOST:
      throw DeviceError(fmt::format(
          "the Vulkan device was lost while {}: a frame took too long or the driver failed; lower --size or --photons, "
          "or choose another with --device",
          what));
    case VK_ERROR_INCOMPATIBLE_DRIVER:
      throw DeviceError(fmt::format(
          "no Vulkan driver (while {}): install one (mesa-vulkan-drivers draws on the CPU), or use --device cpu",
          what));
    default:
      throw InternalError(fmt::format("Vulkan error {} while {}", static_cast<int>(result), what));
  }
}

}  // namespace nephroid::gpu
