#include "gpu/pipeline.h"

#include <gtest/gtest.h>

namespace nephroid::gpu {
namespace {

/// Of a device that has no more than every device must have.
VkPhysicalDeviceLimits leastLimits() {
  VkPhysicalDeviceLimits limits{};
  limits.maxPerStageDescriptorUniformBuffers = 12;
  limits.maxPerStageDescriptorStorageBuffers = 4;
  limits.maxPerStageDescriptorSampledImages = 16;
  limits.maxPerStageDescriptorStorageImages = 4;
  limits.maxPerStageResources = 128;
  return limits;
}

std::vector<Binding> makeBindings(std::initializer_list<std::pair<VkDescriptorType, std::uint32_t>> counts) {
  std::vector<Binding> bindings;
  for (const auto& [type, count] : counts)
    for (std::uint32_t i = 0; i < count; ++i) bindings.push_back({static_cast<std::uint32_t>(bindings.size()), type});
  return bindings;
}

TEST(FindExceededLimit, AllowsAsManyAsADeviceHas) {
  EXPECT_EQ(findExceededLimit({}, leastLimits()), "");
  const std::vector<Binding> bindings = makeBindings({{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 12},
                                                      {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 4},
                                                      {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 6},
                                                      {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 10},
                                                      {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 3},
                                                      {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, 1}});
  EXPECT_EQ(findExceededLimit(bindings, leastLimits()), "");
}

TEST(FindExceededLimit, NamesWhatThereAreTooManyOf) {
  EXPECT_EQ(findExceededLimit(makeBindings({{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 13}}), leastLimits()),
            "13 uniform buffers (12 at the most)");
  EXPECT_EQ(findExceededLimit(makeBindings({{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 5}}), leastLimits()),
            "5 storage buffers (4 at the most)");
  // Buffers of texels count as images.
  EXPECT_EQ(findExceededLimit(makeBindings({{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1},
                                            {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 16}}),
                              leastLimits()),
            "17 sampled images (16 at the most)");
  EXPECT_EQ(findExceededLimit(
                makeBindings({{VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, 2}, {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 3}}),
                leastLimits()),
            "5 storage images (4 at the most)");
}

TEST(FindExceededLimit, CountsAllTogether) {
  VkPhysicalDeviceLimits limits = leastLimits();
  limits.maxPerStageResources = 7;
  const auto bindings = makeBindings({{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 4}, {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 4}});
  EXPECT_EQ(findExceededLimit(bindings, limits), "8 resources (7 at the most)");
}

}  // namespace
}  // namespace nephroid::gpu
