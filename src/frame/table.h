// Tables that shaders fetch texel by texel (frame/tables.glsl): buffers of texels of four words.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "gpu/commands.h"

namespace nephroid {

/// A buffer that holds `texels`; one texel of zeros if there are none.
/// @param format  of one texel
/// @throws ResourceError if the device makes no buffer of so many
gpu::Buffer makeTexelTable(gpu::Device& device, gpu::CommandRecorder& recorder, VkFormat format,
                           std::span<const std::byte> texels, std::string_view name);

/// A table of records, whose size is a multiple of a texel's.
template <class Record>
gpu::Buffer makeTable(gpu::Device& device, gpu::CommandRecorder& recorder, std::span<const Record> records,
                      std::string_view name) {
  static_assert(sizeof(Record) % 16 == 0);
  return makeTexelTable(device, recorder, VK_FORMAT_R32G32B32A32_UINT, std::as_bytes(records), name);
}

/// A buffer of `count` records that shaders read as uniforms. A word at a constant place of it is read once for all
/// threads wherever it is asked for. Of a storage buffer, a device that is a CPU reads it for each thread anew where
/// threads may go different ways, which took half of the time of some passes.
/// It may be a table (frame/passes.h) of other passes, too.
template <class Record>
gpu::Buffer makeUniforms(gpu::Device& device, std::size_t count, std::string_view name) {
  return {device, count * sizeof(Record), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
          gpu::MemoryIntent::kDevice, name};
}

/// A buffer for as many texels of four words, which shaders write. @throws ResourceError as above
gpu::Buffer makeWrittenTable(gpu::Device& device, std::uint64_t texels, std::string_view name);

}  // namespace nephroid
