#include "gpu/commands.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "core/assert.h"
#include "nephroid/error.h"

namespace nephroid::gpu {
namespace {

/// Passes of one submission that are timed; those beyond are not.
constexpr std::uint32_t kTimedPasses = 256;

struct AccessInfo {
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
  VkImageLayout layout;
  bool writes;
};

AccessInfo describe(Access access) {
  constexpr VkPipelineStageFlags2 kShaders =
      VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  constexpr VkPipelineStageFlags2 kDepth =
      VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
  switch (access) {
    case Access::kTransferRead:
      return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
              false};
    case Access::kTransferWrite:
      return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, true};
    case Access::kComputeRead:
      return {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT,
              VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, false};
    case Access::kStorageRead:
      return {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT, VK_IMAGE_LAYOUT_GENERAL, false};
    case Access::kDispatchRead:
      return {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
              VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT,
              VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, false};
    case Access::kDispatchWrite:
      return {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
              VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT,
              VK_IMAGE_LAYOUT_GENERAL, true};
    case Access::kComputeWrite:
      return {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT,
              VK_IMAGE_LAYOUT_GENERAL, true};
    case Access::kGraphicsRead:
      return {kShaders, VK_ACCESS_2_SHADER_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, false};
    case Access::kGraphicsWrite:
      return {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT,
              VK_IMAGE_LAYOUT_GENERAL, true};
    case Access::kVertexFetch:
      return {VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT, VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_2_INDEX_READ_BIT,
              VK_IMAGE_LAYOUT_UNDEFINED, false};
    case Access::kColorTarget:
      return {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
              VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
              VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, true};
    case Access::kDepthTarget:
      return {kDepth, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
              VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, true};
  }
  throw InternalError("an access that is not listed");
}

constexpr VkAccessFlags2 kAllWrites = VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_SHADER_WRITE_BIT |
                                      VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                      VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;

struct Wait {
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  bool needed = false;
};

/// What the next use has to wait for; notes the use.
Wait advance(ResourceState& state, const AccessInfo& next, VkImageLayout layout) {
  Wait wait{.stages = state.write_stages, .access = state.write_access};
  const bool moves = layout != state.layout;
  if (next.writes || moves) {
    // Everything before, reads too, must be over.
    wait.stages |= state.read_stages;
    wait.needed = wait.stages != 0 || moves;
    // A change of layout is a write of its own.
    state = {.write_stages = next.stages, .write_access = next.access & kAllWrites, .layout = layout};
    if (!next.writes) state.read_stages = next.stages, state.read_access = next.access;
    return wait;
  }
  const bool seen = (next.stages & ~state.read_stages) == 0 && (next.access & ~state.read_access) == 0;
  wait.needed = !seen && state.write_stages != 0;
  state.read_stages |= next.stages;
  state.read_access |= next.access;
  return wait;
}

}  // namespace

// ------------------------------------------------------------------------------------------------ PassCommands

void PassCommands::bind(const Pipeline& pipeline) {
  pipeline_ = &pipeline;
  device_.api().CmdBindPipeline(commands_, pipeline.bindPoint(), pipeline.handle());
}

void PassCommands::bindResources(std::span<const Bound> resources) {
  constexpr std::size_t kMost = 32;  // of one push; Vulkan promises 32
  NEPHROID_ASSERT_LE(resources.size(), kMost);
  std::array<VkDescriptorBufferInfo, kMost> buffers{};
  std::array<VkDescriptorImageInfo, kMost> images{};
  std::array<VkWriteDescriptorSet, kMost> writes{};
  for (std::size_t i = 0; i < resources.size(); ++i) {
    const Bound& bound = resources[i];
    const VkDescriptorType type = pipeline_->typeOf(bound.binding);
    VkWriteDescriptorSet& write = writes[i];
    write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
             .dstBinding = bound.binding,
             .descriptorCount = 1,
             .descriptorType = type};
    if (type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER || type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER) {
      write.pTexelBufferView = &bound.buffer->texelView();
    } else if (bound.buffer) {
      buffers[i] = {bound.buffer->handle(), 0, VK_WHOLE_SIZE};
      write.pBufferInfo = &buffers[i];
    } else {
      images[i] = {bound.sampler, bound.view,
                   type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE ? VK_IMAGE_LAYOUT_GENERAL
                                                            : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
      write.pImageInfo = &images[i];
    }
  }
  device_.api().CmdPushDescriptorSetKHR(commands_, pipeline_->bindPoint(), pipeline_->layout(), 0,
                                        static_cast<std::uint32_t>(resources.size()), writes.data());
}

void PassCommands::pushBytes(const void* data, std::size_t size) {
  const VkShaderStageFlags stages = pipeline_->bindPoint() == VK_PIPELINE_BIND_POINT_COMPUTE
                                        ? VK_SHADER_STAGE_COMPUTE_BIT
                                        : VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
  device_.api().CmdPushConstants(commands_, pipeline_->layout(), stages, 0, static_cast<std::uint32_t>(size), data);
}

void PassCommands::dispatch(std::uint32_t groups_x, std::uint32_t groups_y, std::uint32_t groups_z) {
  device_.api().CmdDispatch(commands_, groups_x, groups_y, groups_z);
}

void PassCommands::dispatchIndirect(const Buffer& groups, VkDeviceSize offset) {
  device_.api().CmdDispatchIndirect(commands_, groups.handle(), offset);
}

void PassCommands::beginRendering(const RenderTargets& targets) {
  std::vector<VkRenderingAttachmentInfo> colors;
  VkExtent2D extent{};
  for (const ColorAttachment& color : targets.colors) {
    colors.push_back({.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                      .imageView = color.image.layerView(targets.color_layer),
                      .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                      .loadOp = color.clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD,
                      .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                      .clearValue = {.color = color.value}});
    extent = color.image.extent();
  }
  VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  if (targets.depth) {
    depth.imageView = targets.depth->layerView(targets.depth_layer);
    depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.loadOp = targets.clear_depth ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
    depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    depth.clearValue.depthStencil.depth = targets.depth_value;
    extent = targets.depth->extent();
  }
  const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                             .renderArea = {{0, 0}, extent},
                             .layerCount = 1,
                             .colorAttachmentCount = static_cast<std::uint32_t>(colors.size()),
                             .pColorAttachments = colors.data(),
                             .pDepthAttachment = targets.depth ? &depth : nullptr};
  const DeviceApi& api = device_.api();
  api.CmdBeginRendering(commands_, &info);
  const VkViewport viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0.0F, 1.0F};
  const VkRect2D scissor{{0, 0}, extent};
  api.CmdSetViewport(commands_, 0, 1, &viewport);
  api.CmdSetScissor(commands_, 0, 1, &scissor);
}

void PassCommands::endRendering() { device_.api().CmdEndRendering(commands_); }

void PassCommands::bindVertexBuffer(const Buffer& buffer, std::uint32_t slot) {
  const VkBuffer handle = buffer.handle();
  const VkDeviceSize offset = 0;
  device_.api().CmdBindVertexBuffers(commands_, slot, 1, &handle, &offset);
}

void PassCommands::bindIndexBuffer(const Buffer& buffer) {
  device_.api().CmdBindIndexBuffer(commands_, buffer.handle(), 0, VK_INDEX_TYPE_UINT32);
}

void PassCommands::draw(std::uint32_t vertices, std::uint32_t instances) {
  device_.api().CmdDraw(commands_, vertices, instances, 0, 0);
}

void PassCommands::drawIndexed(std::uint32_t indices, std::uint32_t first_index, std::int32_t vertex_offset,
                               std::uint32_t instances, std::uint32_t first_instance) {
  device_.api().CmdDrawIndexed(commands_, indices, instances, first_index, vertex_offset, first_instance);
}

void PassCommands::copy(const Buffer& from, const Buffer& to, VkDeviceSize bytes, VkDeviceSize from_offset,
                        VkDeviceSize to_offset) {
  const VkBufferCopy region{from_offset, to_offset, bytes};
  device_.api().CmdCopyBuffer(commands_, from.handle(), to.handle(), 1, &region);
}

void PassCommands::copy(const Buffer& from, const Image& to, std::uint32_t mip) {
  const ImageDesc& desc = to.desc();
  const VkBufferImageCopy region{.imageSubresource = {to.aspect(), mip, 0, desc.layers},
                                 .imageExtent = {std::max(desc.width >> mip, 1U), std::max(desc.height >> mip, 1U), 1}};
  device_.api().CmdCopyBufferToImage(commands_, from.handle(), to.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                                     &region);
}

void PassCommands::copy(const Image& from, const Buffer& to) {
  const ImageDesc& desc = from.desc();
  const VkBufferImageCopy region{.imageSubresource = {from.aspect(), 0, 0, desc.layers},
                                 .imageExtent = {desc.width, desc.height, 1}};
  device_.api().CmdCopyImageToBuffer(commands_, from.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle(), 1,
                                     &region);
}

void PassCommands::blit(const Image& from, const Image& to) {
  const auto corner = [](const Image& image) {
    return VkOffset3D{static_cast<std::int32_t>(image.desc().width), static_cast<std::int32_t>(image.desc().height), 1};
  };
  const VkImageBlit region{.srcSubresource = {from.aspect(), 0, 0, 1},
                           .srcOffsets = {{0, 0, 0}, corner(from)},
                           .dstSubresource = {to.aspect(), 0, 0, 1},
                           .dstOffsets = {{0, 0, 0}, corner(to)}};
  device_.api().CmdBlitImage(commands_, from.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle(),
                             VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_NEAREST);
}

void PassCommands::fill(const Buffer& buffer, std::uint32_t value, VkDeviceSize offset, VkDeviceSize bytes) {
  device_.api().CmdFillBuffer(commands_, buffer.handle(), offset, bytes, value);
}

void PassCommands::clear(const Image& image, const VkClearColorValue& value) {
  const VkImageSubresourceRange range{image.aspect(), 0, image.desc().mips, 0, image.desc().layers};
  device_.api().CmdClearColorImage(commands_, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &value, 1, &range);
}

// ------------------------------------------------------------------------------------------------ CommandRecorder

CommandRecorder::CommandRecorder(Device& device) : device_(device) {
  const DeviceApi& api = device.api();
  const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                     .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                     .queueFamilyIndex = device.queueFamily()};
  check(api.CreateCommandPool(device.handle(), &pool, nullptr, &pool_), "creating a command pool");
  const VkCommandBufferAllocateInfo buffer{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = pool_,
                                           .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                           .commandBufferCount = 1};
  check(api.AllocateCommandBuffers(device.handle(), &buffer, &commands_), "creating a command buffer");
  if (device.timestampTickMs() <= 0) return;
  const VkQueryPoolCreateInfo queries{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                      .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                      .queryCount = kTimedPasses + 1};
  check(api.CreateQueryPool(device.handle(), &queries, nullptr, &queries_), "creating timestamps");
}

CommandRecorder::~CommandRecorder() {
  device_.retire([device = &device_, pool = pool_, queries = queries_] {
    device->api().DestroyCommandPool(device->handle(), pool, nullptr);
    if (queries) device->api().DestroyQueryPool(device->handle(), queries, nullptr);
  });
}

void CommandRecorder::begin() {
  wait();
  const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  check(device_.api().BeginCommandBuffer(commands_, &info), "beginning a frame");
  pass_names_.clear();
  if (!queries_) return;
  device_.api().ResetQueryPool(device_.handle(), queries_, 0, kTimedPasses + 1);
  writeTimestamp(0);
}

void CommandRecorder::writeTimestamp(std::uint32_t index) {
  if (queries_ && index <= kTimedPasses)
    device_.api().CmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_, index);
}

void CommandRecorder::pass(const char* name, std::span<const Use> uses,
                           const std::function<void(PassCommands&)>& record) {
  device_.beginLabel(commands_, name);
  barrier(uses);
  PassCommands commands(device_, commands_);
  record(commands);
  device_.endLabel(commands_);
  pass_names_.emplace_back(name);
  writeTimestamp(static_cast<std::uint32_t>(pass_names_.size()));
}

void CommandRecorder::barrier(std::span<const Use> uses) {
  VkMemoryBarrier2 memory{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  bool memory_needed = false;
  std::vector<VkImageMemoryBarrier2> images;
  for (const Use& use : uses) {
    const AccessInfo next = describe(use.access);
    if (const auto* buffer = std::get_if<const Buffer*>(&use.resource)) {
      const Wait wait = advance((*buffer)->state(), next, VK_IMAGE_LAYOUT_UNDEFINED);
      if (!wait.needed) continue;
      memory_needed = true;
      memory.srcStageMask |= wait.stages;
      memory.srcAccessMask |= wait.access;
      memory.dstStageMask |= next.stages;
      memory.dstAccessMask |= next.access;
      continue;
    }
    const Image& image = *std::get<const Image*>(use.resource);
    const VkImageLayout before = image.state().layout;
    const Wait wait = advance(image.state(), next, next.layout);
    if (!wait.needed) continue;
    images.push_back({.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                      .srcStageMask = wait.stages,
                      .srcAccessMask = wait.access,
                      .dstStageMask = next.stages,
                      .dstAccessMask = next.access,
                      .oldLayout = use.discard ? VK_IMAGE_LAYOUT_UNDEFINED : before,
                      .newLayout = next.layout,
                      .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                      .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                      .image = image.handle(),
                      .subresourceRange = {image.allAspects(), 0, image.desc().mips, 0, image.desc().layers}});
  }
  if (!memory_needed && images.empty()) return;
  const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                              .memoryBarrierCount = memory_needed ? 1U : 0U,
                              .pMemoryBarriers = &memory,
                              .imageMemoryBarrierCount = static_cast<std::uint32_t>(images.size()),
                              .pImageMemoryBarriers = images.data()};
  device_.api().CmdPipelineBarrier2(commands_, &info);
}

void CommandRecorder::handOver(const Image& image, VkImageLayout layout) {
  const VkImageLayout before = image.state().layout;
  const Wait wait = advance(
      image.state(),
      {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT, layout, true},
      layout);
  const VkImageMemoryBarrier2 barrier{
      .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
      .srcStageMask = wait.stages,
      .srcAccessMask = wait.access,
      .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
      .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
      .oldLayout = before,
      .newLayout = layout,
      .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .image = image.handle(),
      .subresourceRange = {image.allAspects(), 0, image.desc().mips, 0, image.desc().layers}};
  const VkDependencyInfo info{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier};
  device_.api().CmdPipelineBarrier2(commands_, &info);
}

void CommandRecorder::upload(const Buffer& to, std::span<const std::byte> bytes, VkDeviceSize offset) {
  Buffer& staging = staging_.emplace_back(device_, bytes.size(), 0, MemoryIntent::kUpload, "staging");
  std::memcpy(staging.mapped().data(), bytes.data(), bytes.size());
  pass("upload", {Use(to, Access::kTransferWrite)},
       [&](PassCommands& commands) { commands.copy(staging, to, bytes.size(), 0, offset); });
}

void CommandRecorder::upload(const Image& to, std::span<const std::byte> bytes) {
  Buffer& staging = staging_.emplace_back(device_, bytes.size(), 0, MemoryIntent::kUpload, "staging");
  std::memcpy(staging.mapped().data(), bytes.data(), bytes.size());
  pass("upload", {Use(to, Access::kTransferWrite)}, [&](PassCommands& commands) { commands.copy(staging, to); });
}

void CommandRecorder::submit() {
  // Whatever was copied for the host is visible to it once the submission is waited for.
  const VkMemoryBarrier2 to_host{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                 .srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                 .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                 .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                 .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
  const VkDependencyInfo info{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &to_host};
  device_.api().CmdPipelineBarrier2(commands_, &info);
  check(device_.api().EndCommandBuffer(commands_), "ending a frame");
  number_ = device_.submit(commands_);
  staging_.clear();  // destroyed when the submission is done
}

void CommandRecorder::wait() {
  if (number_ == 0) return;
  device_.wait(number_);
  number_ = 0;
  readTimestamps();
}

void CommandRecorder::readTimestamps() {
  times_.clear();
  if (!queries_) return;
  const auto count = std::min(static_cast<std::uint32_t>(pass_names_.size()), kTimedPasses);
  std::vector<std::uint64_t> ticks(count + 1);
  check(device_.api().GetQueryPoolResults(device_.handle(), queries_, 0, count + 1,
                                          ticks.size() * sizeof(std::uint64_t), ticks.data(), sizeof(std::uint64_t),
                                          VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
        "reading timestamps");
  for (std::uint32_t i = 0; i < count; ++i)
    times_.push_back({pass_names_[i], static_cast<double>(ticks[i + 1] - ticks[i]) * device_.timestampTickMs()});
}

// ------------------------------------------------------------------------------------------------ reading back

namespace {

template <class Resource>
std::vector<std::byte> readBackBytes(Device& device, const Resource& resource, VkDeviceSize bytes,
                                     const std::function<void(PassCommands&, const Buffer&)>& copy) {
  const Buffer target(device, bytes, 0, MemoryIntent::kReadback, "read back");
  CommandRecorder recorder(device);
  recorder.begin();
  recorder.pass("read back", {Use(resource, Access::kTransferRead), Use(target, Access::kTransferWrite)},
                [&](PassCommands& commands) { copy(commands, target); });
  recorder.submit();
  recorder.wait();
  return {target.mapped().begin(), target.mapped().end()};
}

}  // namespace

std::vector<std::byte> readBack(Device& device, const Buffer& buffer) {
  return readBackBytes(device, buffer, buffer.size(), [&](PassCommands& commands, const Buffer& target) {
    commands.copy(buffer, target, buffer.size());
  });
}

std::vector<std::byte> readBack(Device& device, const Image& image) {
  const ImageDesc& desc = image.desc();
  const VkDeviceSize bytes = VkDeviceSize{texelBytes(desc.format)} * desc.width * desc.height * desc.layers;
  return readBackBytes(device, image, bytes,
                       [&](PassCommands& commands, const Buffer& target) { commands.copy(image, target); });
}

}  // namespace nephroid::gpu
