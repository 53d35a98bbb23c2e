// The sum of layers, weighted, and the histogram of its luminances.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/display.shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D layer_0;
layout(set = 0, binding = 1) uniform sampler2D layer_1;
layout(set = 0, binding = 2) uniform sampler2D layer_2;
layout(set = 0, binding = 3) uniform sampler2D layer_3;
layout(set = 0, binding = 4, rgba32f) writeonly uniform image2D composed;
layout(scalar, set = 0, binding = 5) buffer Histogram { uint cells[]; };

layout(push_constant, scalar) uniform Push { DisplayPush push; };

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(composed);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  vec3 sum = push.weights.x * texelFetch(layer_0, pixel, 0).xyz;
  if (push.weights.y != 0.0) sum += push.weights.y * texelFetch(layer_1, pixel, 0).xyz;
  if (push.weights.z != 0.0) sum += push.weights.z * texelFetch(layer_2, pixel, 0).xyz;
  if (push.weights.w != 0.0) sum += push.weights.w * texelFetch(layer_3, pixel, 0).xyz;
  imageStore(composed, pixel, vec4(sum, 1.0));
  float luminance = dot(sum, vec3(0.2126, 0.7152, 0.0722));
  if (push.is_automatic == 0u || !(luminance > 0.0) || isinf(luminance)) return;
  float cell = floor((log2(luminance) - kFirstOctave) * float(kCellsPerOctave));
  atomicAdd(cells[uint(clamp(cell, 0.0, float(kHistogramCells - 1u)))], 1u);
}
