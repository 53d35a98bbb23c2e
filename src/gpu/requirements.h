// What nephroid asks of a device: one list, used to judge devices and to create one.
#pragma once

#include <string>
#include <vector>

#include "gpu/api.h"

namespace nephroid::gpu {

/// Vulkan's feature structures, chained. Not copied: the chain points into itself.
class Features {
 public:
  Features();
  Features(const Features&) = delete;
  Features& operator=(const Features&) = delete;

  /// Sets what a device must have; everything else is off.
  void requireNeeded();
  /// Names of what a device must have and is not set here.
  std::vector<std::string> lacking();
  bool floatAtomics() const {
    return atomic_float_.shaderBufferFloat32AtomicAdd && atomic_float_.shaderImageFloat32AtomicAdd;
  }
  bool int64Atomics() const { return core_.features.shaderInt64 && vulkan12_.shaderBufferInt64Atomics; }
  /// Asks for what is welcome and not needed. @param available  of the device
  void takeWelcome(const Features& available);

  /// For asking and, on devices that have every extension that is spoken of, for creating.
  VkPhysicalDeviceFeatures2* chain() { return &core_; }
  /// For creating devices without the extensions that are only welcome.
  VkPhysicalDeviceFeatures2* chainWithoutExtensions() {
    vulkan13_.pNext = nullptr;
    return &core_;
  }

 private:
  struct Needed {
    VkBool32* flag;
    const char* name;
  };
  std::vector<Needed> needed();

  VkPhysicalDeviceFeatures2 core_{};
  VkPhysicalDeviceVulkan12Features vulkan12_{};
  VkPhysicalDeviceVulkan13Features vulkan13_{};
  VkPhysicalDeviceShaderAtomicFloatFeaturesEXT atomic_float_{};
};

/// Extensions without which nothing works.
std::vector<const char*> neededExtensions();

}  // namespace nephroid::gpu
