#include "frame/photon_buffer.h"

#include <fmt/format.h>

#include <algorithm>

#include "nephroid/error.h"

namespace nephroid {

PhotonBuffer::PhotonBuffer(gpu::Device& device, std::uint32_t capacity, std::uint32_t align) : capacity_(capacity) {
  // Written as records, read as texels.
  constexpr std::uint32_t kTexelsEach = sizeof(Photon) / 16;
  std::uint64_t most = std::min<std::uint64_t>(device.limits().maxStorageBufferRange / sizeof(Photon),
                                               device.limits().maxTexelBufferElements / kTexelsEach);
  most -= most % align;
  if (most == 0)
    throw ResourceError(
        fmt::format("{} photons together are more than {} lets a buffer have; lower --photons", align, device.name()));
  for (std::uint32_t first = 0; first < capacity; first += chunks_.back().count) {
    const auto count = static_cast<std::uint32_t>(std::min<std::uint64_t>(most, capacity - first));
    chunks_.push_back({first, count,
                       gpu::Buffer(device, VkDeviceSize{count} * sizeof(Photon),
                                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
                                   gpu::MemoryIntent::kDevice, "photons")});
  }
}

void PhotonBuffer::makeSquares(gpu::Device& device) {
  const std::uint32_t count = acrossSquares(batch.grid_width) * acrossSquares(batch.grid_height);
  squares = gpu::Buffer(device, VkDeviceSize{count} * sizeof(std::uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                        gpu::MemoryIntent::kDevice, "squares of photons");
}

std::vector<Photon> readPhotons(gpu::Device& device, const PhotonBuffer& photons) {
  std::vector<Photon> all;
  all.reserve(photons.capacity());
  for (const PhotonBuffer::Chunk& chunk : photons.chunks()) {
    const auto some = gpu::readBackAs<Photon>(device, chunk.buffer);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

}  // namespace nephroid
