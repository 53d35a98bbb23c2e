// Irradiance by pixel and where it comes from: what reconstruction yields and shading takes.
#pragma once

#include <cstdint>

#include "gpu/commands.h"

namespace nephroid {

/// Passes add to both; several sources of light may share them.
struct IrradianceImages {
  gpu::Image irradiance;  ///< RGBA32F; RGB in W/m², signed where bands of wavelength are
  /// RGBA32F: the sum of directions along the travel of light, each times its luminance of irradiance, and in A the sum
  /// of these. RGB/A is the flux-weighted mean direction; the shorter it is, the farther they spread.
  gpu::Image direction;
};

/// @throws ResourceError
IrradianceImages makeIrradianceImages(gpu::Device& device, std::uint32_t width, std::uint32_t height);

/// Records that both are set to zero.
void clearIrradiance(gpu::CommandRecorder& recorder, const IrradianceImages& images);

}  // namespace nephroid
