// glTF materials, textures and images.
#pragma once

#include <cstdint>

#include "scene/import/gltf_document.h"
#include "scene/scene_data.h"

namespace nephroid::gltf {

/// What KHR_materials_ior's 0 becomes: that extension's way to say "reflects everything" (Fresnel term 1), for which
/// an index of infinity is the physical reading. F0 = 0.999996; finite, so that no ratio of indices is 0 or NaN.
inline constexpr float kInfiniteIor = 1e6F;

/// Appends all materials of the file to `scene.materials`, in order, and the images that they use to `scene.images`.
/// Values outside their range are clamped and warned about; what only has a meaning to rasterisers is warned about.
/// @throws InputError on indices that lead nowhere, images that cannot be read, and KTX2 without an alternative
void readMaterials(Document& document, SceneData& scene);

/// glTF's default material: white, metallic 1, roughness 1.
Material makeDefaultMaterial();

/// KHR_texture_transform as a matrix on (u, v, 1): scale, then rotation, then offset. A positive rotation turns
/// counter-clockwise in the picture, where v points down: u' = cos·u + sin·v, v' = −sin·u + cos·v. (The extension's
/// GLSL sample turns the other way; its worked example, its text and all viewers agree on this.)
mat3 makeTextureTransform(vec2 offset, float rotation, vec2 scale);

}  // namespace nephroid::gltf
