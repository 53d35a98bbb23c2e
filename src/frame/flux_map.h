// Flux by texel of a view's picture: what photons are deposited into, of the light (a caustic map) or of a camera.
#pragma once

#include <cstdint>

#include "frame/deposit.shared.h"
#include "frame/flux_levels.h"
#include "gpu/commands.h"

namespace nephroid {

/// Flux is kept in whole numbers, so that a sum does not depend on its order: two runs give the same picture.
/// Move-only.
class FluxMap {
 public:
  FluxMap() = default;
  /// @param width, height  texels of each picture
  /// @param views          pictures, one behind the other
  /// @param directions     also keeps where the light comes from
  /// @throws ResourceError
  FluxMap(gpu::Device& device, std::uint32_t width, std::uint32_t height, std::uint32_t views, bool directions);

  /// Records that it is empty from now on, and what its whole numbers are.
  /// @param most  W: no less than the flux of all that will be deposited, signs left out; of the largest channel
  void clear(gpu::CommandRecorder& recorder, float most);

  bool valid() const { return flux_.valid(); }
  std::uint32_t width() const { return flux_.desc().width; }
  std::uint32_t height() const { return flux_.desc().height; }
  bool hasDirections() const { return channels_ > kFluxChannels; }
  std::uint32_t channels() const { return channels_; }
  /// One step of the numbers, W.
  float quantum() const { return quantum_; }
  /// R32_SINT array, `channels` layers a view: red, green, blue and, with directions, x, y, z of the luminance times
  /// the direction of travel.
  const gpu::Image& flux() const { return flux_; }
  /// R32_UINT array, a layer a view: 1 in tiles of kDepositTile texels along a side that hold some flux.
  const gpu::Image& tiles() const { return tiles_; }
  /// Three whole numbers: red, green and blue of what could not be deposited, because another surface is seen there.
  const gpu::Buffer& lost() const { return lost_; }
  /// Where large cells are deposited, until Deposit::finish adds them to `flux`.
  const FluxLevels& levels() const { return levels_; }

 private:
  std::uint32_t channels_ = kFluxChannels;
  float quantum_ = 1.0F;
  gpu::Image flux_, tiles_;
  gpu::Buffer lost_;
  FluxLevels levels_;
};

}  // namespace nephroid
