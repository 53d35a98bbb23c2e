#include "gpu/requirements.h"

namespace nephroid::gpu {

Features::Features() {
  core_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  core_.pNext = &vulkan12_;
  vulkan12_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  vulkan12_.pNext = &vulkan13_;
  vulkan13_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  vulkan13_.pNext = &atomic_float_;
  atomic_float_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_FEATURES_EXT;
}

std::vector<Features::Needed> Features::needed() {
  return {
      {&core_.features.geometryShader, "geometryShader"},   // gl_PrimitiveID where fragments are shaded
      {&vulkan12_.scalarBlockLayout, "scalarBlockLayout"},  // structs shared with C++, without padding
      {&vulkan12_.timelineSemaphore, "timelineSemaphore"},  // objects outlive the frames that use them
      {&vulkan12_.hostQueryReset, "hostQueryReset"},        // timestamps
      {&vulkan13_.dynamicRendering, "dynamicRendering"},
      {&vulkan13_.maintenance4, "maintenance4"},  // group sizes as constants, as glslang writes them
      {&vulkan13_.synchronization2, "synchronization2"},
  };
}

void Features::requireNeeded() {
  for (const Needed& feature : needed()) *feature.flag = VK_TRUE;
}

void Features::takeWelcome(const Features& available) {
  atomic_float_.shaderBufferFloat32AtomicAdd = available.atomic_float_.shaderBufferFloat32AtomicAdd;
  atomic_float_.shaderImageFloat32AtomicAdd = available.atomic_float_.shaderImageFloat32AtomicAdd;
  core_.features.shaderInt64 = vulkan12_.shaderBufferInt64Atomics = available.int64Atomics() ? VK_TRUE : VK_FALSE;
}

std::vector<std::string> Features::lacking() {
  std::vector<std::string> names;
  for (const Needed& feature : needed())
    if (!*feature.flag) names.emplace_back(feature.name);
  return names;
}

std::vector<const char*> neededExtensions() { return {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME}; }

}  // namespace nephroid::gpu
