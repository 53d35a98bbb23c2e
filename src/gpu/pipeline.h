// Compute and graphics pipelines from SPIR-V that is embedded at build time.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/resources.h"

namespace nephroid::gpu {

/// Words of a compiled shader; entry point `main`.
using Spirv = std::span<const std::uint32_t>;

struct Binding {
  std::uint32_t index = 0;
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
};

/// What there are more bindings of than a device lets a shader have, as "6 storage images (4 at the most)"; empty:
/// nothing. Devices need not let it have more than 4 of some kinds.
std::string findExceededLimit(std::span<const Binding> bindings, const VkPhysicalDeviceLimits& limits);

/// A specialisation constant: 32 bits, a uint or an int or the bits of a float or a bool.
struct Constant {
  std::uint32_t id = 0;
  std::uint32_t value = 0;
};

/// Descriptors are pushed, set 0. Move-only; common to both kinds of pipeline.
class Pipeline {
 public:
  Pipeline() = default;
  Pipeline(Pipeline&& other) noexcept { swap(other); }
  Pipeline& operator=(Pipeline&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Pipeline();

  VkPipeline handle() const { return handle_; }
  VkPipelineLayout layout() const { return layout_; }
  VkPipelineBindPoint bindPoint() const { return bind_point_; }
  VkDescriptorType typeOf(std::uint32_t binding) const;

 protected:
  /// @throws DeviceError if the device lets no shader have so many bindings
  Pipeline(Device& device, VkPipelineBindPoint bind_point, std::span<const Binding> bindings, std::uint32_t push_bytes,
           std::string_view name);
  void nameIt(std::string_view name) const;

  Device* device_ = nullptr;
  VkPipeline handle_ = VK_NULL_HANDLE;

 private:
  void swap(Pipeline& other) noexcept;

  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkPipelineBindPoint bind_point_ = VK_PIPELINE_BIND_POINT_COMPUTE;
  std::vector<Binding> bindings_;
};

struct ComputeDesc {
  Spirv shader;
  std::vector<Binding> bindings;
  std::uint32_t push_bytes = 0;  ///< at most 128
  std::vector<Constant> constants;
};

class ComputePipeline : public Pipeline {
 public:
  ComputePipeline() = default;
  ComputePipeline(Device& device, const ComputeDesc& desc, std::string_view name);
};

/// How a colour target is combined with what is there.
enum class Blend : std::uint8_t { kReplace, kAdd, kMultiply };

struct ColorTarget {
  VkFormat format = VK_FORMAT_UNDEFINED;
  Blend blend = Blend::kReplace;
};

struct GraphicsDesc {
  Spirv vertex, fragment;  ///< fragment may be empty: only depth
  std::vector<Binding> bindings;
  std::uint32_t push_bytes = 0;
  std::vector<Constant> constants;
  std::vector<VkVertexInputBindingDescription> vertex_buffers;
  std::vector<VkVertexInputAttributeDescription> attributes;
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkCullModeFlags cull = VK_CULL_MODE_NONE;
  std::vector<ColorTarget> colors;
  VkFormat depth = VK_FORMAT_UNDEFINED;
  VkCompareOp depth_compare = VK_COMPARE_OP_GREATER;  ///< depths are reversed: 1 near, 0 far
  bool depth_write = true;
};

class GraphicsPipeline : public Pipeline {
 public:
  GraphicsPipeline() = default;
  GraphicsPipeline(Device& device, const GraphicsDesc& desc, std::string_view name);
};

}  // namespace nephroid::gpu
