#include "frame/foreign_lighting.h"

#include "frame/table.h"

namespace nephroid {

ForeignLighting::ForeignLighting(gpu::Device& device, const SceneBuffers& buffers, const LightGrids& lights)
    : device_(device),
      buffers_(buffers),
      lights_(lights),
      // Bound as a view of the frame, too, which nobody reads then but which is larger.
      view_(makeUniforms<ViewRecord>(device, 1, "foreign view")),
      nothing_(device, {.format = VK_FORMAT_R32G32_UINT, .usage = VK_IMAGE_USAGE_STORAGE_BIT}, "nothing seen") {}

void ForeignLighting::record(gpu::CommandRecorder& recorder, const ForeignPicture& picture,
                             const ForeignViewRecord& view, const IrradianceImages& target, const ForeignLight& light,
                             RealtimeTechnique* technique, std::uint32_t sample, float weight) {
  recorder.upload(view_, std::as_bytes(std::span(&view, 1)));
  const PixelSurfaces surfaces =
      PixelSurfaces::ofForeign(view_, picture.depth, picture.normal, nothing_, buffers_.sampler());
  const RealtimeSample lit{surfaces, target, sample, weight};
  if (light.direct) {
    if (!direct_) direct_ = std::make_unique<DirectIrradiance>(device_, buffers_, lights_, true);
    direct_->record(recorder, lit);
  }
  if (technique) technique->record(recorder, lit);
}

}  // namespace nephroid
