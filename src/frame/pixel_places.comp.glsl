// Place and normal of what each pixel shows: the surfaces that a picture of flux lies on.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define NEPHROID_PIXEL_BINDINGS 7
#include "frame/pixel_surface.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 12, rgba32f) writeonly uniform image2DArray surface_image;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(surface_image).xy;
  if (at.x >= size.x || at.y >= size.y) return;
  PixelSurface pixel;
  vec4 value = vec4(uintBitsToFloat(0x7F800000u));  // infinitely far away
  // Water lets what reaches its bed pass, even where that is near.
  bool receives = surfaceOfPixel(at, size, pixel) && (fetchInstance(pixel.instance).flags & kInstanceReceives) != 0u;
  if (receives) value = vec4(pixel.position, uintBitsToFloat(packUnitVector(pixel.geometric)));
  imageStore(surface_image, ivec3(at, 0), value);
}
