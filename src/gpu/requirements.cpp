#include "gpu/requirements.h"

namespace nephroid::gpu {

Features::Features() {
  core_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  core_.pNext = &vulkan11_;
  vulkan11_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
  vulkan11_.pNext = &vulkan12_;
  vulkan12_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  vulkan12_.pNext = &vulkan13_;
  vulkan13_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  vulkan13_.pNext = &atomic_float_;
  atomic_float_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_FEATURES_EXT;
}

void Features::requireNeeded() {
  core_.features.geometryShader = VK_TRUE;            // gl_PrimitiveID where fragments are shaded
  core_.features.independentBlend = VK_TRUE;          // g-buffers of several formats
  core_.features.fragmentStoresAndAtomics = VK_TRUE;  // lists of layers
  vulkan11_.multiview = VK_TRUE;                      // six faces of a cube map in one pass
  vulkan12_.scalarBlockLayout = VK_TRUE;              // structs shared with C++, without padding
  vulkan12_.timelineSemaphore = VK_TRUE;              // objects outlive the frames that use them
  vulkan12_.hostQueryReset = VK_TRUE;                 // timestamps
  vulkan13_.dynamicRendering = VK_TRUE;
  vulkan13_.maintenance4 = VK_TRUE;  // group sizes as constants, as glslang writes them
  vulkan13_.synchronization2 = VK_TRUE;
}

void Features::takeWelcome(const Features& available) {
  atomic_float_.shaderBufferFloat32AtomicAdd = available.atomic_float_.shaderBufferFloat32AtomicAdd;
  atomic_float_.shaderImageFloat32AtomicAdd = available.atomic_float_.shaderImageFloat32AtomicAdd;
}

std::vector<std::string> Features::lacking(const Features& needed) const {
  std::vector<std::string> names;
  const auto compare = [&](VkBool32 wanted, VkBool32 here, const char* name) {
    if (wanted && !here) names.emplace_back(name);
  };
  compare(needed.core_.features.geometryShader, core_.features.geometryShader, "geometryShader");
  compare(needed.core_.features.independentBlend, core_.features.independentBlend, "independentBlend");
  compare(needed.core_.features.fragmentStoresAndAtomics, core_.features.fragmentStoresAndAtomics,
          "fragmentStoresAndAtomics");
  compare(needed.vulkan11_.multiview, vulkan11_.multiview, "multiview");
  compare(needed.vulkan12_.scalarBlockLayout, vulkan12_.scalarBlockLayout, "scalarBlockLayout");
  compare(needed.vulkan12_.timelineSemaphore, vulkan12_.timelineSemaphore, "timelineSemaphore");
  compare(needed.vulkan12_.hostQueryReset, vulkan12_.hostQueryReset, "hostQueryReset");
  compare(needed.vulkan13_.dynamicRendering, vulkan13_.dynamicRendering, "dynamicRendering");
  compare(needed.vulkan13_.maintenance4, vulkan13_.maintenance4, "maintenance4");
  compare(needed.vulkan13_.synchronization2, vulkan13_.synchronization2, "synchronization2");
  return names;
}

std::vector<const char*> neededExtensions() { return {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME}; }

}  // namespace nephroid::gpu
