// How bright two pictures are, as a diagram.
#pragma once

#include <string>

#include "core/image/image.h"

namespace nephroid {

/// An SVG element: the share of pixels by luminance, a quarter of a stop a step, over the 16 stops below the brightest
/// of both; what is darker is said below. The paths have the classes "image" and "reference".
std::string drawHistogram(const Image& image, const Image& reference);

}  // namespace nephroid
