// A frame's commands, in passes that say what they read and write. Barriers, labels and timestamps follow from that.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "gpu/pipeline.h"

namespace nephroid::gpu {

/// What a pass does with a resource.
enum class Access : std::uint8_t {
  kTransferRead,
  kTransferWrite,
  kComputeRead,    ///< buffers, uniform ones too, sampled images
  kStorageRead,    ///< storage images
  kDispatchRead,   ///< buffers, also for the number of groups
  kDispatchWrite,  ///< likewise, and writing
  kComputeWrite,   ///< buffers, storage images; what was there may be kept
  kGraphicsRead,   ///< buffers and sampled images in vertex and fragment shaders
  kGraphicsWrite,  ///< buffers and storage images in fragment shaders
  kVertexFetch,    ///< vertex and index buffers
  kColorTarget,
  kDepthTarget,
};

/// A resource and what is done with it.
struct Use {
  std::variant<const Buffer*, const Image*> resource;
  Access access = Access::kComputeRead;
  bool discard = false;  ///< of an image: what was in it is not wanted

  Use(const Buffer& buffer, Access how) : resource(&buffer), access(how) {}
  Use(const Image& image, Access how, bool discard_contents = false)
      : resource(&image), access(how), discard(discard_contents) {}
};

/// What a shader's binding is given.
struct Bound {
  std::uint32_t binding = 0;
  const Buffer* buffer = nullptr;
  VkImageView view = VK_NULL_HANDLE;
  VkSampler sampler = VK_NULL_HANDLE;

  Bound(std::uint32_t index, const Buffer& b) : binding(index), buffer(&b) {}
  /// Sampled, all layers and mips.
  Bound(std::uint32_t index, const Image& image, const Sampler& s)
      : binding(index), view(image.view()), sampler(s.handle()) {}
  /// Storage: the first mip, as an array if there are layers.
  Bound(std::uint32_t index, const Image& image) : binding(index), view(image.targetView()) {}
};

struct ColorAttachment {
  const Image& image;
  bool clear = true;  ///< else what is there is kept
  VkClearColorValue value{};
};

struct RenderTargets {
  std::vector<ColorAttachment> colors;
  const Image* depth = nullptr;
  std::uint32_t color_layer = 0, depth_layer = 0;  ///< drawn to, of images with several
  bool clear_depth = true;
  float depth_value = 0.0F;  ///< the farthest: depths are drawn reversed, which keeps their digits
};

/// What a pass records with. Valid inside its callback.
class PassCommands {
 public:
  void bind(const Pipeline& pipeline);
  /// For the pipeline that is bound: all of its bindings at once, or a few that change from draw to draw.
  void bindResources(std::span<const Bound> resources);
  void bindResources(std::initializer_list<Bound> resources) {
    bindResources(std::span(resources.begin(), resources.size()));
  }
  template <class Constants>
  void pushConstants(const Constants& constants) {
    pushBytes(&constants, sizeof(Constants));
  }
  /// At least as many threads as said, in groups of the shader's size.
  void dispatch(std::uint32_t groups_x, std::uint32_t groups_y = 1, std::uint32_t groups_z = 1);
  /// As many groups as three words of the buffer say when it comes to that.
  void dispatchIndirect(const Buffer& groups, VkDeviceSize offset);

  /// Begins drawing into the targets: viewport and scissor cover them.
  void beginRendering(const RenderTargets& targets);
  void endRendering();
  void bindVertexBuffer(const Buffer& buffer, std::uint32_t slot = 0);
  void bindIndexBuffer(const Buffer& buffer);  ///< 32-bit indices
  void draw(std::uint32_t vertices, std::uint32_t instances = 1);
  void drawIndexed(std::uint32_t indices, std::uint32_t first_index, std::int32_t vertex_offset,
                   std::uint32_t instances = 1, std::uint32_t first_instance = 0);

  void copy(const Buffer& from, const Buffer& to, VkDeviceSize bytes, VkDeviceSize from_offset = 0,
            VkDeviceSize to_offset = 0);
  /// All layers of one mip; tightly packed in the buffer.
  void copy(const Buffer& from, const Image& to, std::uint32_t mip = 0);
  void copy(const Image& from, const Buffer& to);
  /// The first layer and mip, stretched to fit, converted to the other's format.
  void blit(const Image& from, const Image& to);
  void fill(const Buffer& buffer, std::uint32_t value, VkDeviceSize offset = 0, VkDeviceSize bytes = VK_WHOLE_SIZE);
  void clear(const Image& image, const VkClearColorValue& value);

  VkCommandBuffer handle() const { return commands_; }

 private:
  friend class CommandRecorder;
  PassCommands(Device& device, VkCommandBuffer commands) : device_(device), commands_(commands) {}
  void pushBytes(const void* data, std::size_t size);

  Device& device_;
  VkCommandBuffer commands_;
  const Pipeline* pipeline_ = nullptr;
};

/// Time of one pass on the device.
struct PassTime {
  std::string name;
  double ms = 0;
};

/// Groups of `group` that cover `count`.
constexpr std::uint32_t groupsOf(std::uint32_t count, std::uint32_t group) { return (count + group - 1) / group; }

/// Records one submission. Reused frame after frame: `begin` waits until the last one is done.
class CommandRecorder {
 public:
  explicit CommandRecorder(Device& device);
  ~CommandRecorder();
  CommandRecorder(const CommandRecorder&) = delete;
  CommandRecorder& operator=(const CommandRecorder&) = delete;

  void begin();
  void pass(const char* name, std::span<const Use> uses, const std::function<void(PassCommands&)>& record);
  void pass(const char* name, std::initializer_list<Use> uses, const std::function<void(PassCommands&)>& record) {
    pass(name, std::span(uses.begin(), uses.size()), record);
  }
  /// Copies bytes to a buffer or (tightly packed, all layers, first mip) to an image before what is recorded next.
  void upload(const Buffer& to, std::span<const std::byte> bytes, VkDeviceSize offset = 0);
  void upload(const Image& to, std::span<const std::byte> bytes);
  /// Leaves a foreign image in `layout`, for whatever its owner does with it next on this queue.
  void handOver(const Image& image, VkImageLayout layout);
  /// Makes what a buffer of MemoryIntent::kReadback was given visible to the host after `wait`.
  void submit();
  /// Until the device is done with what was submitted.
  void wait();
  /// By pass, in order, of the last submission that was waited for; empty where the device has no timestamps.
  const std::vector<PassTime>& passTimes() const { return times_; }

 private:
  void barrier(std::span<const Use> uses);
  void writeTimestamp(std::uint32_t index);
  void readTimestamps();

  Device& device_;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  VkQueryPool queries_ = VK_NULL_HANDLE;
  std::uint64_t number_ = 0;  ///< of the last submission; 0: none is under way
  std::vector<std::string> pass_names_;
  std::vector<PassTime> times_;
  std::vector<Buffer> staging_;
};

/// The bytes of a buffer or an image, after everything submitted so far. For tests and for pictures, not for frames.
std::vector<std::byte> readBack(Device& device, const Buffer& buffer);
std::vector<std::byte> readBack(Device& device, const Image& image);

template <class T>
std::vector<T> readBackAs(Device& device, const Buffer& buffer) {
  const std::vector<std::byte> bytes = readBack(device, buffer);
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(static_cast<void*>(values.data()), bytes.data(), values.size() * sizeof(T));
  return values;
}

/// A buffer on the device that holds `values`.
template <class T>
Buffer makeBuffer(Device& device, CommandRecorder& recorder, std::span<const T> values, VkBufferUsageFlags usage,
                  std::string_view name) {
  // Vulkan knows no empty buffers.
  Buffer buffer(device, std::max<VkDeviceSize>(values.size_bytes(), sizeof(T)), usage, MemoryIntent::kDevice, name);
  if (!values.empty()) recorder.upload(buffer, std::as_bytes(values));
  return buffer;
}

}  // namespace nephroid::gpu
