// Texture look-up on the CPU: wrap modes, bilinear filter, sRGB decoding.
#pragma once

#include "scene/scene_data.h"

namespace nephroid {

/// The texel at `texcoord`, RGBA, linear.
/// @param texcoord  as interpolated from the mesh; the reference's transform is applied here
/// @param srgb      decode 8-bit RGB from sRGB (base colour, emission, specular colour); never alpha, never float
vec4 sampleTexture(const TextureImage& texture, const TextureRef& reference, vec2 texcoord, bool srgb);

}  // namespace nephroid
