// Tables that shaders read texel by texel (frame/tables.glsl): images of four words a texel.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "frame/frame.shared.h"
#include "gpu/commands.h"

namespace nephroid {

/// An image that holds `texels` one behind the other, kTableShift to a row; one texel of zeros if there are none.
/// @param format  of one texel
/// @throws ResourceError if the device makes no image so large
gpu::Image makeTexelTable(gpu::Device& device, gpu::CommandRecorder& recorder, VkFormat format,
                          std::span<const std::byte> texels, std::string_view name);

/// A table of records, whose size is a multiple of a texel's.
template <class Record>
gpu::Image makeTable(gpu::Device& device, gpu::CommandRecorder& recorder, std::span<const Record> records,
                     std::string_view name) {
  static_assert(sizeof(Record) % 16 == 0);
  return makeTexelTable(device, recorder, VK_FORMAT_R32G32B32A32_UINT, std::as_bytes(records), name);
}

/// An image for as many texels, which shaders write. @throws ResourceError as above
gpu::Image makeWrittenTable(gpu::Device& device, std::uint64_t texels, std::string_view name);

}  // namespace nephroid
