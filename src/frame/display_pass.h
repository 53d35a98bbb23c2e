// A frame's layers as one picture on the device: their sum, linear or as a screen shows it.
#pragma once

#include <optional>
#include <span>

#include "core/image/tonemap.h"
#include "frame/display.shared.h"
#include "gpu/commands.h"

namespace nephroid {

/// As DisplayOptions of the layers that are read back.
struct FrameDisplay {
  std::optional<float> exposure_ev;  ///< empty: automatic, from the picture itself
  ToneMap tone_map = ToneMap::kClamp;
  bool coded = true;  ///< as sRGB; else linear, for an image whose format codes
};

/// Not thread-safe.
class DisplayPass {
 public:
  /// @throws ResourceError
  DisplayPass(gpu::Device& device, std::uint32_t width, std::uint32_t height);

  /// @throws ResourceError
  void resize(gpu::Device& device, std::uint32_t width, std::uint32_t height);
  /// Records the sum of up to four images, each times `weight`, into `picture`.
  /// @param display  how it is shown; empty: radiance as it is
  void record(gpu::CommandRecorder& recorder, std::span<const gpu::Image* const> layers, float weight,
              const std::optional<FrameDisplay>& display);
  /// RGBA32F.
  const gpu::Image& picture() const { return picture_; }

 private:
  gpu::Sampler sampler_;
  gpu::Image picture_;
  gpu::Buffer histogram_, exposure_;
  gpu::ComputePipeline compose_, expose_, display_;
};

}  // namespace nephroid
