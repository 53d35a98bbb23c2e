// How each layer is shown on a screen, where only colours in [0, 1] exist.
#pragma once

#include <optional>
#include <string_view>

#include "core/image/image.h"
#include "core/image/tonemap.h"

namespace nephroid {

struct DisplayOptions {
  std::optional<float> exposure_ev;  ///< empty: automatic, from `beauty` where there is one, so that layers compare
  ToneMap tone_map = ToneMap::kClamp;
};

/// The layer as sRGB-coded RGB in [0, 1]:
/// radiance by exposure and tone map; `irradiance…` likewise, as the radiance E/π that white paper has in it; `albedo`
/// as it is; `normal` as 0.5 + 0.5 n; `position` and `depth` stretched over the picture's own range, near white; `id`
/// in arbitrary distinct colours, 0 black.
/// @throws UsageError if `image` lacks the layer
Image displayLayer(const LayeredImage& image, std::string_view layer, const DisplayOptions& options);

}  // namespace nephroid
