// Layers that say what is seen rather than how bright it is: albedo, normal, position, depth, id.
#pragma once

#include <string>
#include <vector>

#include "core/image/image.h"
#include "techniques/reference/world.h"

namespace nephroid {

/// One ray through each pixel's centre; holes are looked through.
/// @param names  those of the geometry layers that are wanted; others are passed over
std::vector<Layer> renderGeometryLayers(const ReferenceWorld& world, const std::vector<std::string>& names);

}  // namespace nephroid
