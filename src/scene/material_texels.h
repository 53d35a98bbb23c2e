// What textures make of a material: every combination of values that it has somewhere.
#pragma once

#include <functional>

#include "scene/scene_data.h"

namespace nephroid {

/// Whether a texture bears on how the material reflects and transmits (not its normals, not its emission).
bool hasLobeTextures(const Material& material);

/// Calls `visit` with the material's factors as they are at its texels, untextured: every texel of the largest texture
/// is met, and with it those of the others that lie there, so that no part of a surface is too small to be found.
/// Filtered look-ups lie between texels in every factor and need no visit of their own.
///
/// Of texels that differ in base colour alone only those brighter (in luminance) than all before them need be visited,
/// and combinations that were met lately are not visited again: `visit` must not count.
/// Textures with another transform or UV set than the first may meet any of its texels: they count by their least
/// and largest values per channel.
/// @param material  of `scene`, or a changed copy of one
/// @note            about 5 ns per texel of the largest texture, unless nearly all texels are different
void visitTexels(const SceneData& scene, const Material& material, const std::function<void(const Material&)>& visit);

}  // namespace nephroid
