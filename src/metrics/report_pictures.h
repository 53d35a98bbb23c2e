// Pictures as a comparison's page holds them: as PNG, which every browser decodes.
#pragma once

#include "core/image/image.h"

namespace nephroid {

/// Floats in a picture of bytes, so that the page can expose them.
struct PackedPicture {
  Image bytes;       ///< `2·height × width × 3`, each k/255: the high bytes of half floats above the low ones
  int exponent = 0;  ///< the values are the half floats times 2^exponent
};

/// The largest value becomes 2^14 to 2^15, so values down to 2^-38 of it are kept, to 0.05 %.
PackedPicture packPicture(const Image& picture);

/// A range of values, and the colours that they are shown in.
struct ColourScale {
  bool logarithmic = false;
  bool diverging = false;  ///< white in the middle, blue below, red above; else from black over red to light yellow
  float lower = 0.0F, upper = 1.0F;

  /// In [0, 1], sRGB-coded. What is beyond the range has the colour of its end, NaN a grey blue.
  vec3 colour(float value) const;
};

/// One channel in colours.
Image drawMap(const Image& map, const ColourScale& scale);

}  // namespace nephroid
