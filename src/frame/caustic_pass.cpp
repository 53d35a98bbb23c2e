#include "frame/caustic_pass.h"

#include "frame/passes.h"
#include "shaders/frame/caustic.comp.h"

namespace nephroid {
namespace {

struct CausticPush {
  std::uint32_t frame;
  float specular_alpha;
};

gpu::Image makeSum(gpu::Device& device, const gpu::Image& like, const char* name) {
  return {device,
          {.format = kFloat4,
           .width = like.desc().width,
           .height = like.desc().height,
           .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT},
          name};
}

}  // namespace

CausticPass::CausticPass(gpu::Device& device, const SceneBuffers& buffers, const Inputs& inputs, float specular_alpha)
    : buffers_(buffers),
      inputs_(inputs),
      specular_alpha_(specular_alpha),
      pipeline_(
          device,
          {.shader = shaders::caustic_comp,
           .bindings = SceneBuffers::bindings({kUniforms, kStorage, kTexture, kStorage, kStorage, kStorage, kStorage}),
           .push_bytes = sizeof(CausticPush),
           .constants = buffers.traits().constants()},
          "caustic") {
  fitPicture(device);
}

void CausticPass::fitPicture(gpu::Device& device) {
  target_ = makeIrradianceImages(device, inputs_.seen.desc().width, inputs_.seen.desc().height);
  radiance_ = makeSum(device, inputs_.seen, "caustic");
  irradiance_ = makeSum(device, inputs_.seen, "irradiance of caustics");
}

void CausticPass::record(gpu::CommandRecorder& recorder, std::uint32_t frame) {
  const std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead, {Use(inputs_.camera_view, Access::kComputeRead), Use(inputs_.seen, Access::kStorageRead),
                             Use(inputs_.tint, Access::kComputeRead), Use(target_.irradiance, Access::kStorageRead),
                             Use(target_.direction, Access::kStorageRead), Use(radiance_, Access::kComputeWrite),
                             Use(irradiance_, Access::kComputeWrite)});
  recorder.pass("caustic", uses, [&](PassCommands& commands) {
    const gpu::Sampler& nearest = buffers_.sampler();
    commands.bind(pipeline_);
    commands.bindResources(buffers_.bound(
        {Bound(7, inputs_.camera_view), Bound(8, inputs_.seen), Bound(9, inputs_.tint, nearest),
         Bound(10, target_.irradiance), Bound(11, target_.direction), Bound(12, radiance_), Bound(13, irradiance_)}));
    commands.pushConstants(CausticPush{frame, specular_alpha_});
    commands.dispatch(gpu::groupsOf(radiance_.desc().width, kPixelGroup),
                      gpu::groupsOf(radiance_.desc().height, kPixelGroup));
  });
}

}  // namespace nephroid
