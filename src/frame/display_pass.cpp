#include "frame/display_pass.h"

#include "core/assert.h"
#include "frame/passes.h"
#include "shaders/frame/compose.comp.h"
#include "shaders/frame/display.comp.h"
#include "shaders/frame/exposure.comp.h"

namespace nephroid {
namespace {

constexpr std::uint32_t kMostLayers = 4;

gpu::Buffer makeWords(gpu::Device& device, std::uint32_t count, const char* name) {
  return {device, count * sizeof(std::uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryIntent::kDevice, name};
}

DisplayPush describe(std::size_t layers, float weight, const std::optional<FrameDisplay>& display) {
  DisplayPush push{};
  for (std::size_t i = 0; i < layers; ++i) push.weights[static_cast<int>(i)] = weight;
  if (!display) return push;
  push.is_automatic = display->exposure_ev ? 0 : 1;
  push.exposure_ev = display->exposure_ev.value_or(0.0F);
  push.is_filmic = display->tone_map == ToneMap::kFilmic ? 1 : 0;
  push.is_coded = display->coded ? 1 : 0;
  return push;
}

}  // namespace

DisplayPass::DisplayPass(gpu::Device& device, std::uint32_t width, std::uint32_t height)
    : sampler_(device, {.filter = VK_FILTER_NEAREST}, "layers"),
      histogram_(makeWords(device, kHistogramCells, "histogram")),
      exposure_(makeWords(device, 1, "exposure")),
      compose_(device,
               {.shader = shaders::compose_comp,
                .bindings = {{0, kTexture}, {1, kTexture}, {2, kTexture}, {3, kTexture}, {4, kStorage}, {5, kTable}},
                .push_bytes = sizeof(DisplayPush)},
               "compose"),
      expose_(device, {.shader = shaders::exposure_comp, .bindings = {{0, kTable}, {1, kTable}}}, "exposure"),
      display_(device,
               {.shader = shaders::display_comp,
                .bindings = {{0, kStorage}, {1, kTable}},
                .push_bytes = sizeof(DisplayPush)},
               "display") {
  resize(device, width, height);
}

void DisplayPass::resize(gpu::Device& device, std::uint32_t width, std::uint32_t height) {
  picture_ = gpu::Image(
      device, {.format = kFloat4, .width = width, .height = height, .usage = VK_IMAGE_USAGE_STORAGE_BIT}, "picture");
}

void DisplayPass::record(gpu::CommandRecorder& recorder, std::span<const gpu::Image* const> layers, float weight,
                         const std::optional<FrameDisplay>& display) {
  NEPHROID_ASSERT_LE(layers.size(), std::size_t{kMostLayers});
  NEPHROID_ASSERT_LE(std::size_t{1}, layers.size());
  const DisplayPush push = describe(layers.size(), weight, display);
  const std::uint32_t groups_x = gpu::groupsOf(picture_.desc().width, kPixelGroup);
  const std::uint32_t groups_y = gpu::groupsOf(picture_.desc().height, kPixelGroup);
  if (push.is_automatic != 0)
    recorder.pass("clear histogram", {Use(histogram_, Access::kTransferWrite)},
                  [&](PassCommands& commands) { commands.fill(histogram_, 0); });
  std::vector<Use> uses{Use(picture_, Access::kComputeWrite, true), Use(histogram_, Access::kComputeWrite)};
  for (const gpu::Image* layer : layers) uses.emplace_back(*layer, Access::kComputeRead);
  recorder.pass("compose", uses, [&](PassCommands& commands) {
    commands.bind(compose_);
    std::vector<Bound> bound{Bound(kMostLayers, picture_), Bound(kMostLayers + 1, histogram_)};
    // Where there are fewer, something has to be bound; its weight is zero.
    for (std::uint32_t i = 0; i < kMostLayers; ++i) bound.emplace_back(i, *layers[i < layers.size() ? i : 0], sampler_);
    commands.bindResources(bound);
    commands.pushConstants(push);
    commands.dispatch(groups_x, groups_y);
  });
  if (!display) return;
  if (push.is_automatic != 0)
    recorder.pass("exposure", {Use(histogram_, Access::kComputeRead), Use(exposure_, Access::kComputeWrite)},
                  [&](PassCommands& commands) {
                    commands.bind(expose_);
                    commands.bindResources({Bound(0, histogram_), Bound(1, exposure_)});
                    commands.dispatch(1);
                  });
  recorder.pass("display", {Use(picture_, Access::kComputeWrite), Use(exposure_, Access::kComputeRead)},
                [&](PassCommands& commands) {
                  commands.bind(display_);
                  commands.bindResources({Bound(0, picture_), Bound(1, exposure_)});
                  commands.pushConstants(push);
                  commands.dispatch(groups_x, groups_y);
                });
}

}  // namespace nephroid
