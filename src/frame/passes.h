// The words that the frame's passes are written with.
#pragma once

#include <cstdint>

#include "gpu/commands.h"

namespace nephroid {

using gpu::Access;
using gpu::Bound;
using gpu::PassCommands;
using gpu::Use;

inline constexpr VkDescriptorType kTable = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
/// A small buffer of a size that shaders know (makeUniforms).
inline constexpr VkDescriptorType kUniforms = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
/// A buffer of texels, to fetch them from or to store them to.
inline constexpr VkDescriptorType kTexels = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
inline constexpr VkDescriptorType kStoredTexels = VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
inline constexpr VkDescriptorType kTexture = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
inline constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;

/// Threads of a group along each side, in passes over pixels and cells.
inline constexpr std::uint32_t kPixelGroup = 8;

/// Of sums and of what is read back.
inline constexpr VkFormat kFloat4 = VK_FORMAT_R32G32B32A32_SFLOAT;

}  // namespace nephroid
