// From the flux in each pixel to the irradiance on the surface that it shows, added to what is there.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/deposit.shared.h"
#include "frame/frame.shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform Views { ViewRecord views[1]; };
const uint kViewCount = 1u;
#include "frame/texel_surface.glsl"
layout(set = 0, binding = 1, rgba32f) readonly uniform image2DArray surfaces;
layout(set = 0, binding = 2, r32i) readonly uniform iimage2DArray flux_image;
layout(set = 0, binding = 3, r32ui) readonly uniform uimage2DArray tile_image;
layout(set = 0, binding = 4, rgba32f) uniform image2D irradiance_image;  // W/m²
layout(set = 0, binding = 5, rgba32f) uniform image2D direction_image;

layout(constant_id = 0) const bool kHasDirections = false;

layout(push_constant, scalar) uniform Push { float watts; };  // of a step of the flux

vec3 fetchVector(ivec2 at, int first_layer) {
  return vec3(imageLoad(flux_image, ivec3(at, first_layer)).x, imageLoad(flux_image, ivec3(at, first_layer + 1)).x,
              imageLoad(flux_image, ivec3(at, first_layer + 2)).x);
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(irradiance_image);
  if (at.x >= size.x || at.y >= size.y) return;
  if (imageLoad(tile_image, ivec3(at / int(kDepositTile), 0)).x == 0u) return;
  TexelSurface s = describeTexel(imageLoad(surfaces, ivec3(at, 0)));
  float per_area = watts / texelArea(s, vec2(at) + 0.5, vec2(size));
  vec3 irradiance = per_area * fetchVector(at, 0);
  imageStore(irradiance_image, at, imageLoad(irradiance_image, at) + vec4(irradiance, 0.0));
  if (!kHasDirections) return;
  vec4 direction = vec4(per_area * fetchVector(at, 3), dot(irradiance, vec3(0.2126, 0.7152, 0.0722)));
  imageStore(direction_image, at, imageLoad(direction_image, at) + direction);
}
