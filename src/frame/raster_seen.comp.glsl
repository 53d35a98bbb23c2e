// Which triangle each pixel sees, where one that was drawn here is no farther than what the hardware drew.
//
// Leaves no keys behind: the next picture begins with none.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/raster.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 11) uniform usamplerBuffer key_texels;              // keys, to be read
layout(set = 0, binding = 12) uniform sampler2D depth_image;                  // of the hardware's
layout(set = 0, binding = 13, rg32ui) writeonly uniform uimage2D seen_image;  // instance + 1, triangle
layout(set = 0, binding = 14) uniform usamplerBuffer draw_texels;             // first number, instance

/// @return  instance + 1, triangle
uvec2 nameOf(uint number) {
  uint first = 0u, end = push.draw_count;
  uvec4 draw = texelFetch(draw_texels, 0);
  while (end - first > 1u) {
    uint middle = (first + end) / 2u;
    uvec4 of_middle = texelFetch(draw_texels, int(middle));
    bool is_before = of_middle.x <= number;
    if (is_before) draw = of_middle;
    first = is_before ? middle : first;
    end = is_before ? end : middle;
  }
  return uvec2(draw.y + 1u, number - draw.x);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(push.first_x, push.first_y);
  if (pixel.x >= push.size_x || pixel.y >= push.size_y) return;
  uvec2 key = texelFetch(key_texels, int(indexOf(pixel))).xy;
  if (key == uvec2(0u)) return;
  keys[indexOf(pixel)] = 0ul;
  float depth = texelFetch(depth_image, pixel, 0).x;
  if (uintBitsToFloat(key.y) >= depth) imageStore(seen_image, pixel, uvec4(nameOf(~key.x), 0u, 0u));
}
