// Lists the pixels that may show a lobe of class S: those that have none cost the pass that follows nothing.
//
// The list's order differs between runs, what becomes of a pixel does not.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/tables.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 7) uniform usampler2D seen_image;
layout(set = 0, binding = 8) uniform sampler2D tint_image;  // of what lies before what is shown
layout(scalar, set = 0, binding = 9) buffer Pixels { uint pixel_count; uint pixels[]; };  // x + 2^16 y

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = textureSize(seen_image, 0);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  uvec2 seen = texelFetch(seen_image, pixel, 0).xy;
  bool wanted = false;
  if (seen.x != 0u) {
    uint material = texelFetch(instance_table, texelOf(5u * (seen.x - 1u) + 3u), 0).y;
    wanted = (texelFetch(material_table, texelOf(9u * material + 3u), 0).w & kMaterialIsSpecular) != 0u;
  }
  // A pane takes at least what it reflects.
  if (kSceneHasPassable) wanted = wanted || texelFetch(tint_image, pixel, 0).xyz != vec3(1.0);
  if (wanted) pixels[atomicAdd(pixel_count, 1u)] = uint(pixel.x) | (uint(pixel.y) << 16);
}
