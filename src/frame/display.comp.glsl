// From radiance to what a screen shows: exposure, tone curve, code.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/display.shared.h"
#include "core/image/tonemap.shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform image2D picture;
layout(scalar, set = 0, binding = 1) readonly buffer Exposure { float automatic_ev; };

layout(push_constant, scalar) uniform Push { DisplayPush push; };

float show(float radiance) {
  float positive = radiance > 0.0 ? radiance : 0.0;  // what is not a number is black, too
  float mapped = push.is_filmic != 0u ? applyFilmicCurve(positive) : min(positive, 1.0);
  return push.is_coded != 0u ? srgbFromLinear(mapped) : mapped;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(picture);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  float scale = exp2(push.is_automatic != 0u ? automatic_ev : push.exposure_ev);
  vec3 radiance = scale * imageLoad(picture, pixel).xyz;
  imageStore(picture, pixel, vec4(show(radiance.x), show(radiance.y), show(radiance.z), 1.0));
}
