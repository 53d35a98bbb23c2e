// From sums of directions, weighted by luminance, to their mean.
#version 460

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform image2D direction;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(direction);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  vec4 sum = imageLoad(direction, pixel);
  // Of bands of wavelength with negative weights, the sum may be about zero, and its mean then says nothing.
  vec3 mean = sum.w > 0.0 ? sum.xyz / sum.w : vec3(0.0);
  float squared = dot(mean, mean);
  if (squared > 1.0) mean *= inversesqrt(squared);
  imageStore(direction, pixel, vec4(mean, 1.0));
}
