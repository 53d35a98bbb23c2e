#include "frame/shade_pass.h"

#include "frame/passes.h"
#include "shaders/frame/shade.comp.h"
#include "shaders/frame/shade_blocks.comp.h"

namespace nephroid {
namespace {

/// kBlock of frame/shade.glsl.
constexpr std::uint32_t kBlockSide = 4;
/// Words of ListHead of frame/shade.glsl: groups along x, y, z, and the count of what is listed.
constexpr VkDeviceSize kWord = sizeof(std::uint32_t), kHeadWords = 4;
/// Its lists of blocks.
constexpr VkDeviceSize kMixedBlocks = 0, kShadowedBlocks = 1, kListCount = 2;
/// Constant of frame/shade.comp.glsl and frame/shade_blocks.comp.glsl: not all blocks, but those of their list.
constexpr std::uint32_t kOfList = 17;

gpu::ComputePipeline makePass(gpu::Device& device, gpu::Spirv shader, std::vector<gpu::Constant> constants,
                              const std::vector<gpu::Constant>& lights, const char* name) {
  constants.insert(constants.end(), lights.begin(), lights.end());
  return {device,
          {.shader = shader,
           .bindings = SceneBuffers::bindings({kTexels, kTexels, kTexels, kTable, kUniforms, kStorage, kTexture,
                                               kTexels, kTexture, kStorage, kStorage, kTable}),
           .push_bytes = sizeof(SamplePush),
           .constants = std::move(constants)},
          name};
}

bool wantsBlocks(Shading shading, const gpu::Device& device, const SceneTraits& scene, const LightTraits& lights) {
  // What each pixel decides by chance is not one triangle all over, and a block keeps the shadows of few lights.
  if (scene.passable || lights.fewCount() == 0 || shading == Shading::kPixels) return false;
  return shading == Shading::kBlocks || device.isCpu();
}

}  // namespace

ShadePass::ShadePass(gpu::Device& device, const SceneBuffers& buffers, const ShadingInputs& inputs,
                     const std::vector<gpu::Constant>& lights, Shading shading)
    : buffers_(buffers),
      inputs_(inputs),
      has_blocks_(wantsBlocks(shading, device, buffers.traits(), inputs.grids.traits())) {
  std::vector<gpu::Constant> constants = buffers.traits().constants();
  if (has_blocks_) {
    blocks_ = makePass(device, shaders::shade_blocks_comp, constants, lights, "shade blocks");
    constants.push_back({kOfList, true});
    shadowed_blocks_ = makePass(device, shaders::shade_blocks_comp, constants, lights, "shade shadowed blocks");
  }
  pixels_ = makePass(device, shaders::shade_comp, constants, lights, "shade");
  fitPicture(device);
}

void ShadePass::fitPicture(gpu::Device& device) {
  const gpu::ImageDesc& seen = inputs_.seen.desc();
  const gpu::ImageDesc sum{.format = kFloat4,
                           .width = seen.width,
                           .height = seen.height,
                           .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT};
  direct_ = gpu::Image(device, sum, "direct");
  emission_ = gpu::Image(device, sum, "emission");
  const VkDeviceSize blocks =
      has_blocks_ ? VkDeviceSize{gpu::groupsOf(seen.width, kBlockSide)} * gpu::groupsOf(seen.height, kBlockSide) : 1;
  lists_ = gpu::Buffer(device, kListCount * (kHeadWords + blocks) * kWord,
                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
                       gpu::MemoryIntent::kDevice, "lists of blocks");
}

std::vector<gpu::Use> ShadePass::uses() const {
  std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead, {Use(inputs_.camera_view, Access::kComputeRead), Use(inputs_.seen, Access::kStorageRead),
                             Use(inputs_.tint, Access::kComputeRead), Use(inputs_.lamps, Access::kComputeRead),
                             Use(inputs_.environment, Access::kComputeRead), Use(direct_, Access::kComputeWrite),
                             Use(emission_, Access::kComputeWrite), Use(lists_, Access::kDispatchWrite)});
  const std::vector<Use> of_lights = inputs_.grids.uses();
  uses.insert(uses.end(), of_lights.begin(), of_lights.end());
  return uses;
}

std::vector<gpu::Bound> ShadePass::bound() const {
  const gpu::Sampler& nearest = buffers_.sampler();
  std::vector<Bound> bound =
      buffers_.bound({Bound(11, inputs_.camera_view), Bound(12, inputs_.seen), Bound(13, inputs_.tint, nearest),
                      Bound(14, inputs_.lamps), Bound(15, inputs_.environment, inputs_.environment_sampler),
                      Bound(16, direct_), Bound(17, emission_), Bound(18, lists_)});
  const std::vector<Bound> of_lights = inputs_.grids.bound(SceneBuffers::kBindings);
  bound.insert(bound.end(), of_lights.begin(), of_lights.end());
  return bound;
}

void ShadePass::record(gpu::CommandRecorder& recorder, const SamplePush& sample) {
  const std::uint32_t width = inputs_.seen.desc().width, height = inputs_.seen.desc().height;
  const auto pass = [&](const char* name, const gpu::ComputePipeline& pipeline, const auto& dispatch) {
    recorder.pass(name, uses(), [&](PassCommands& commands) {
      commands.bind(pipeline);
      commands.bindResources(bound());
      commands.pushConstants(sample);
      dispatch(commands);
    });
  };
  if (!has_blocks_) {
    pass("shade", pixels_, [&](PassCommands& commands) {
      commands.dispatch(gpu::groupsOf(width, kPixelGroup), gpu::groupsOf(height, kPixelGroup));
    });
    return;
  }
  recorder.pass("clear blocks", {Use(lists_, Access::kTransferWrite)}, [&](PassCommands& commands) {
    for (VkDeviceSize list = 0; list < kListCount; ++list) {
      const VkDeviceSize head = list * kHeadWords * kWord;
      commands.fill(lists_, 0, head, kWord);
      commands.fill(lists_, 1, head + kWord, 2 * kWord);
      commands.fill(lists_, 0, head + 3 * kWord, kWord);
    }
  });
  pass("shade blocks", blocks_, [&](PassCommands& commands) {
    commands.dispatch(gpu::groupsOf(width, kPixelGroup * kBlockSide), gpu::groupsOf(height, kPixelGroup * kBlockSide));
  });
  const auto listed = [&](VkDeviceSize list) {
    return [this, list](PassCommands& commands) { commands.dispatchIndirect(lists_, list * kHeadWords * kWord); };
  };
  pass("shade shadowed blocks", shadowed_blocks_, listed(kShadowedBlocks));
  pass("shade", pixels_, listed(kMixedBlocks));
}

}  // namespace nephroid
