#include "gpu/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "core/assert.h"
#include "nephroid/error.h"

namespace nephroid::gpu {
namespace {

/// Lives while a pipeline is made from it.
class ShaderModule {
 public:
  ShaderModule(const Device& device, Spirv words) : device_(device) {
    const VkShaderModuleCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = words.size_bytes(), .pCode = words.data()};
    check(device.api().CreateShaderModule(device.handle(), &info, nullptr, &handle_), "loading a shader");
  }
  ~ShaderModule() { device_.api().DestroyShaderModule(device_.handle(), handle_, nullptr); }
  ShaderModule(const ShaderModule&) = delete;
  ShaderModule& operator=(const ShaderModule&) = delete;
  VkShaderModule handle() const { return handle_; }

 private:
  const Device& device_;
  VkShaderModule handle_ = VK_NULL_HANDLE;
};

/// Constants in the form that Vulkan wants; points into itself and into what it was made from.
struct Specialization {
  explicit Specialization(std::span<const Constant> constants) {
    for (const Constant& constant : constants) {
      entries.push_back(
          {constant.id, static_cast<std::uint32_t>(values.size() * sizeof(std::uint32_t)), sizeof(std::uint32_t)});
      values.push_back(constant.value);
    }
    info = {static_cast<std::uint32_t>(entries.size()), entries.data(), values.size() * sizeof(std::uint32_t),
            values.data()};
  }
  Specialization(const Specialization&) = delete;
  Specialization& operator=(const Specialization&) = delete;

  std::vector<VkSpecializationMapEntry> entries;
  std::vector<std::uint32_t> values;
  VkSpecializationInfo info;
};

VkPipelineShaderStageCreateInfo describeStage(VkShaderStageFlagBits stage, const ShaderModule& module,
                                              const Specialization& constants) {
  return {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
          .stage = stage,
          .module = module.handle(),
          .pName = "main",
          .pSpecializationInfo = &constants.info};
}

VkPipelineColorBlendAttachmentState describeBlend(Blend blend) {
  VkPipelineColorBlendAttachmentState state{.blendEnable = blend != Blend::kReplace,
                                            .srcColorBlendFactor = VK_BLEND_FACTOR_ONE,
                                            .dstColorBlendFactor = VK_BLEND_FACTOR_ONE,
                                            .colorBlendOp = VK_BLEND_OP_ADD,
                                            .srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
                                            .dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
                                            .alphaBlendOp = VK_BLEND_OP_ADD,
                                            .colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                                                              VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT};
  if (blend == Blend::kMultiply) {
    state.srcColorBlendFactor = state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
    state.dstColorBlendFactor = VK_BLEND_FACTOR_SRC_COLOR;
    state.dstAlphaBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
  }
  return state;
}

}  // namespace

std::string findExceededLimit(std::span<const Binding> bindings, const VkPhysicalDeviceLimits& limits) {
  struct Kind {
    const char* name;
    std::uint32_t most;
    std::array<VkDescriptorType, 2> types;
  };
  const std::array<Kind, 4> kinds{{
      {"uniform buffers",
       limits.maxPerStageDescriptorUniformBuffers,
       {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}},
      {"storage buffers",
       limits.maxPerStageDescriptorStorageBuffers,
       {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}},
      {"sampled images",
       limits.maxPerStageDescriptorSampledImages,
       {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER}},
      {"storage images",
       limits.maxPerStageDescriptorStorageImages,
       {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER}},
  }};
  for (const Kind& kind : kinds) {
    const auto count = std::ranges::count_if(bindings, [&](const Binding& binding) {
      return std::ranges::find(kind.types, binding.type) != kind.types.end();
    });
    if (count > kind.most) return fmt::format("{} {} ({} at the most)", count, kind.name, kind.most);
  }
  if (bindings.size() > limits.maxPerStageResources)
    return fmt::format("{} resources ({} at the most)", bindings.size(), limits.maxPerStageResources);
  return {};
}

Pipeline::Pipeline(Device& device, VkPipelineBindPoint bind_point, std::span<const Binding> bindings,
                   std::uint32_t push_bytes, std::string_view name)
    : device_(&device), bind_point_(bind_point), bindings_(bindings.begin(), bindings.end()) {
  if (const std::string exceeded = findExceededLimit(bindings, device.limits()); !exceeded.empty())
    throw DeviceError(fmt::format("the pass '{}' needs {} and {} allows no more; use another device or --device cpu",
                                  name, exceeded, device.name()));
  const VkShaderStageFlags stages = bind_point == VK_PIPELINE_BIND_POINT_COMPUTE
                                        ? VK_SHADER_STAGE_COMPUTE_BIT
                                        : VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
  std::vector<VkDescriptorSetLayoutBinding> sets;
  for (const Binding& binding : bindings)
    sets.push_back(
        {.binding = binding.index, .descriptorType = binding.type, .descriptorCount = 1, .stageFlags = stages});
  const VkDescriptorSetLayoutCreateInfo set_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                 .flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR,
                                                 .bindingCount = static_cast<std::uint32_t>(sets.size()),
                                                 .pBindings = sets.data()};
  const std::string what = fmt::format("creating the layout of '{}'", name);
  check(device.api().CreateDescriptorSetLayout(device.handle(), &set_info, nullptr, &set_layout_), what);
  const VkPushConstantRange push{stages, 0, push_bytes};
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .setLayoutCount = 1,
                                        .pSetLayouts = &set_layout_,
                                        .pushConstantRangeCount = push_bytes > 0 ? 1U : 0U,
                                        .pPushConstantRanges = &push};
  check(device.api().CreatePipelineLayout(device.handle(), &info, nullptr, &layout_), what);
}

Pipeline::~Pipeline() {
  if (!device_) return;
  device_->retire([device = device_, handle = handle_, layout = layout_, set = set_layout_] {
    device->api().DestroyPipeline(device->handle(), handle, nullptr);
    device->api().DestroyPipelineLayout(device->handle(), layout, nullptr);
    device->api().DestroyDescriptorSetLayout(device->handle(), set, nullptr);
  });
}

void Pipeline::swap(Pipeline& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(handle_, other.handle_);
  std::swap(layout_, other.layout_);
  std::swap(set_layout_, other.set_layout_);
  std::swap(bind_point_, other.bind_point_);
  std::swap(bindings_, other.bindings_);
}

VkDescriptorType Pipeline::typeOf(std::uint32_t binding) const {
  const auto at =
      std::find_if(bindings_.begin(), bindings_.end(), [&](const Binding& b) { return b.index == binding; });
  NEPHROID_ASSERT_LT(at - bindings_.begin(), static_cast<std::ptrdiff_t>(bindings_.size()));
  return at->type;
}

void Pipeline::nameIt(std::string_view name) const {
  device_->setName(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(handle_), name);
}

ComputePipeline::ComputePipeline(Device& device, const ComputeDesc& desc, std::string_view name)
    : Pipeline(device, VK_PIPELINE_BIND_POINT_COMPUTE, desc.bindings, desc.push_bytes, name) {
  const ShaderModule module(device, desc.shader);
  const Specialization constants(desc.constants);
  const VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                         .stage = describeStage(VK_SHADER_STAGE_COMPUTE_BIT, module, constants),
                                         .layout = layout()};
  check(device.api().CreateComputePipelines(device.handle(), device.pipelineCache(), 1, &info, nullptr, &handle_),
        fmt::format("compiling '{}'", name));
  nameIt(name);
}

GraphicsPipeline::GraphicsPipeline(Device& device, const GraphicsDesc& desc, std::string_view name)
    : Pipeline(device, VK_PIPELINE_BIND_POINT_GRAPHICS, desc.bindings, desc.push_bytes, name) {
  const ShaderModule vertex(device, desc.vertex);
  const bool draws_colour = !desc.fragment.empty();
  const ShaderModule fragment(device, draws_colour ? desc.fragment : desc.vertex);
  const Specialization constants(desc.constants);
  const VkPipelineShaderStageCreateInfo stages[] = {describeStage(VK_SHADER_STAGE_VERTEX_BIT, vertex, constants),
                                                    describeStage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment, constants)};
  const VkPipelineVertexInputStateCreateInfo input{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
      .vertexBindingDescriptionCount = static_cast<std::uint32_t>(desc.vertex_buffers.size()),
      .pVertexBindingDescriptions = desc.vertex_buffers.data(),
      .vertexAttributeDescriptionCount = static_cast<std::uint32_t>(desc.attributes.size()),
      .pVertexAttributeDescriptions = desc.attributes.data()};
  const VkPipelineInputAssemblyStateCreateInfo assembly{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO, .topology = desc.topology};
  const VkPipelineViewportStateCreateInfo viewport{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1};
  const VkPipelineRasterizationStateCreateInfo raster{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
      .polygonMode = VK_POLYGON_MODE_FILL,
      .cullMode = desc.cull,
      .frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE,
      .lineWidth = 1.0F};
  const VkPipelineMultisampleStateCreateInfo samples{.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
                                                     .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
  const VkPipelineDepthStencilStateCreateInfo depth{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
      .depthTestEnable = desc.depth != VK_FORMAT_UNDEFINED,
      .depthWriteEnable = desc.depth != VK_FORMAT_UNDEFINED && desc.depth_write,
      .depthCompareOp = desc.depth_compare};
  std::vector<VkPipelineColorBlendAttachmentState> blends;
  std::vector<VkFormat> formats;
  for (const ColorTarget& target : desc.colors) {
    blends.push_back(describeBlend(target.blend));
    formats.push_back(target.format);
  }
  const VkPipelineColorBlendStateCreateInfo blend{.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                                                  .attachmentCount = static_cast<std::uint32_t>(blends.size()),
                                                  .pAttachments = blends.data()};
  const VkDynamicState dynamic_states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  const VkPipelineDynamicStateCreateInfo dynamic{.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                                 .dynamicStateCount = 2,
                                                 .pDynamicStates = dynamic_states};
  const VkPipelineRenderingCreateInfo rendering{.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                .colorAttachmentCount = static_cast<std::uint32_t>(formats.size()),
                                                .pColorAttachmentFormats = formats.data(),
                                                .depthAttachmentFormat = desc.depth};
  const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                          .pNext = &rendering,
                                          .stageCount = draws_colour ? 2U : 1U,
                                          .pStages = stages,
                                          .pVertexInputState = &input,
                                          .pInputAssemblyState = &assembly,
                                          .pViewportState = &viewport,
                                          .pRasterizationState = &raster,
                                          .pMultisampleState = &samples,
                                          .pDepthStencilState = &depth,
                                          .pColorBlendState = &blend,
                                          .pDynamicState = &dynamic,
                                          .layout = layout()};
  check(device.api().CreateGraphicsPipelines(device.handle(), device.pipelineCache(), 1, &info, nullptr, &handle_),
        fmt::format("compiling '{}'", name));
  nameIt(name);
}

}  // namespace nephroid::gpu
