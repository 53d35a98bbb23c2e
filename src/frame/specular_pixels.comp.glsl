// Lists the pixels that may show a lobe of class S: those that have none cost the pass that follows nothing.
//
// The list's order differs between runs, what becomes of a pixel does not.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/specular_push.glsl"
#define NEPHROID_GRID_BINDINGS 7
#include "frame/specular_grid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 9) uniform sampler2D tint_image;  // of what lies before what is shown

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(seen_image);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  uint seen = imageLoad(seen_image, pixel).x;
  bool wanted = false;
  if (seen != 0u) wanted = isSpecular(seen - 1u);
  // A pane takes at least what it reflects.
  if (kSceneHasPassable) wanted = wanted || texelFetch(tint_image, pixel, 0).xyz != vec3(1.0);
  if (wanted) listed[extend(kFollowedPixels, 1u)] = packPlace(uvec2(pixel));
}
