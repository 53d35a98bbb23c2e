#include "gpu/memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "nephroid/error.h"

namespace nephroid::gpu {

void Allocation::swap(Allocation& other) noexcept {
  std::swap(allocator_, other.allocator_);
  std::swap(block_, other.block_);
  std::swap(memory_, other.memory_);
  std::swap(offset_, other.offset_);
  std::swap(size_, other.size_);
  std::swap(mapped_, other.mapped_);
}

Allocation::~Allocation() {
  if (allocator_) allocator_->release(block_, offset_, size_);
}

MemoryAllocator::MemoryAllocator(const InstanceApi& instance, VkPhysicalDevice physical, const DeviceApi& api,
                                 VkDevice device)
    : api_(api), device_(device) {
  instance.GetPhysicalDeviceMemoryProperties(physical, &properties_);
}

MemoryAllocator::~MemoryAllocator() {
  for (Block& block : blocks_)
    if (block.memory) api_.FreeMemory(device_, block.memory, nullptr);
}

std::uint32_t MemoryAllocator::findType(std::uint32_t allowed, MemoryIntent intent) const {
  constexpr VkMemoryPropertyFlags kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  // What is wished for first, then what must be.
  std::array<VkMemoryPropertyFlags, 2> wishes{};
  if (intent == MemoryIntent::kDevice) wishes = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
  if (intent == MemoryIntent::kUpload) wishes = {kHost, kHost};
  if (intent == MemoryIntent::kReadback) wishes = {kHost | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, kHost};
  for (const VkMemoryPropertyFlags wish : wishes)
    for (std::uint32_t i = 0; i < properties_.memoryTypeCount; ++i)
      if ((allowed >> i & 1U) != 0 && (properties_.memoryTypes[i].propertyFlags & wish) == wish) return i;
  throw InternalError("the Vulkan device has no type of memory that fits");
}

std::size_t MemoryAllocator::addBlock(VkDeviceSize size, std::uint32_t type, MemoryIntent intent, bool linear,
                                      std::string_view what) {
  const std::string doing = fmt::format("allocating {:.1f} MiB for '{}'", static_cast<double>(size) / (1 << 20), what);
  // A driver may do anything when asked for more than there is.
  if (size > properties_.memoryHeaps[properties_.memoryTypes[type].heapIndex].size)
    check(VK_ERROR_OUT_OF_DEVICE_MEMORY, doing);
  const VkMemoryAllocateInfo info{
      .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = size, .memoryTypeIndex = type};
  Block block{.size = size, .type = type, .intent = intent, .linear = linear, .free = {{0, size}}};
  check(api_.AllocateMemory(device_, &info, nullptr, &block.memory), doing);
  if (intent != MemoryIntent::kDevice) {
    void* mapped = nullptr;
    const VkResult result = api_.MapMemory(device_, block.memory, 0, VK_WHOLE_SIZE, 0, &mapped);
    if (result != VK_SUCCESS) api_.FreeMemory(device_, block.memory, nullptr);
    check(result, fmt::format("mapping memory for '{}'", what));
    block.mapped = static_cast<std::byte*>(mapped);
  }
  // A place that was emptied is taken again: allocations know their block by its index.
  const auto empty = std::find_if(blocks_.begin(), blocks_.end(), [](const Block& b) { return !b.memory; });
  if (empty != blocks_.end()) {
    *empty = std::move(block);
    return static_cast<std::size_t>(empty - blocks_.begin());
  }
  blocks_.push_back(std::move(block));
  return blocks_.size() - 1;
}

bool MemoryAllocator::carve(Block& block, const VkMemoryRequirements& requirements, VkDeviceSize& offset) {
  for (std::size_t i = 0; i < block.free.size(); ++i) {
    const Range range = block.free[i];
    offset = (range.begin + requirements.alignment - 1) / requirements.alignment * requirements.alignment;
    if (offset + requirements.size > range.end) continue;
    block.free.erase(block.free.begin() + static_cast<std::ptrdiff_t>(i));
    auto at = block.free.begin() + static_cast<std::ptrdiff_t>(i);
    if (offset + requirements.size < range.end) at = block.free.insert(at, {offset + requirements.size, range.end});
    if (range.begin < offset) block.free.insert(at, {range.begin, offset});
    return true;
  }
  return false;
}

Allocation MemoryAllocator::allocate(const VkMemoryRequirements& requirements, MemoryIntent intent, bool linear,
                                     std::string_view what) {
  const std::lock_guard lock(guard_);
  const std::uint32_t type = findType(requirements.memoryTypeBits, intent);
  Allocation a;
  a.allocator_ = nullptr;
  std::size_t index = 0;
  for (; index < blocks_.size(); ++index) {
    Block& block = blocks_[index];
    if (block.memory && block.type == type && block.intent == intent && block.linear == linear &&
        carve(block, requirements, a.offset_))
      break;
  }
  if (index == blocks_.size()) {
    index = addBlock(std::max(requirements.size, kBlockBytes), type, intent, linear, what);
    carve(blocks_[index], requirements, a.offset_);
  }
  const Block& block = blocks_[index];
  a.allocator_ = this;
  a.block_ = index;
  a.memory_ = block.memory;
  a.size_ = requirements.size;
  a.mapped_ = block.mapped ? block.mapped + a.offset_ : nullptr;
  used_ += requirements.size;
  peak_ = std::max(peak_, used_);
  return a;
}

void MemoryAllocator::release(std::size_t index, VkDeviceSize offset, VkDeviceSize size) {
  const std::lock_guard lock(guard_);
  used_ -= size;
  Block& block = blocks_[index];
  const auto at = std::find_if(block.free.begin(), block.free.end(), [&](const Range& r) { return r.begin > offset; });
  auto here = block.free.insert(at, {offset, offset + size});
  if (const auto next = here + 1; next != block.free.end() && next->begin == here->end) {
    here->end = next->end;
    block.free.erase(next);
  }
  // `erase` behind it leaves `here` valid.
  if (here != block.free.begin() && (here - 1)->end == here->begin) {
    (here - 1)->end = here->end;
    here = block.free.erase(here) - 1;
  }
  const bool whole = here->begin == 0 && here->end == block.size;
  // One empty block of the usual size is kept: frames come and go.
  if (!whole || block.size == kBlockBytes) return;
  api_.FreeMemory(device_, block.memory, nullptr);
  block = Block{};
}

VkDeviceSize MemoryAllocator::usedBytes() const {
  const std::lock_guard lock(guard_);
  return used_;
}

VkDeviceSize MemoryAllocator::peakBytes() const {
  const std::lock_guard lock(guard_);
  return peak_;
}

}  // namespace nephroid::gpu
