// The irradiance of a caustic map at the surface of each pixel ([shah-caustics-mapping] §III-B, last pass).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#define NEPHROID_PIXEL_BINDINGS 7
#include "frame/pixel_surface.glsl"
#include "frame/deposit.shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 12) uniform Views { ViewRecord views[kMostViews]; };
layout(constant_id = 21) const uint kViewCount = 1u;
#include "frame/texel_surface.glsl"
layout(set = 0, binding = 13, rgba32f) readonly uniform image2DArray surfaces;
layout(set = 0, binding = 14, r32i) readonly uniform iimage2DArray flux_image;
layout(set = 0, binding = 15, r32ui) readonly uniform uimage2DArray tile_image;
layout(set = 0, binding = 16, rgba32f) uniform image2D irradiance_image;  // W/m²
layout(set = 0, binding = 17, rgba32f) uniform image2D direction_image;

layout(constant_id = 20) const bool kHasDirections = false;

layout(push_constant, scalar) uniform Push {
  uint size;          // texels along a side of each view's picture
  uint layer_count;   // of each view, in the image of surfaces
  float watts;        // of a step of the flux, times the weight of the sample
} push;

const uint kChannels = kHasDirections ? 2u * kFluxChannels : kFluxChannels;
/// Least cosine between the normals of a pixel and a texel that show the same surface.
const float kSameNormal = 0.5;

struct Found {
  vec3 irradiance;
  vec3 direction;
  float weight;
};

/// What a texel has of the pixel's surface. Of a surface that bends texels differ from the pixel's plane by a part of
/// their size.
Found fetchFlux(ivec2 texel, uint v, PixelSurface pixel, float reach) {
  Found found = Found(vec3(0.0), vec3(0.0), 0.0);
  TexelSurface s = describeTexel(imageLoad(surfaces, ivec3(texel, v * push.layer_count)));
  if (!liesOn(s, pixel.position, reach) || dot(s.lit_normal, pixel.geometric) < kSameNormal) return found;
  int layer = int(v * kChannels);
  vec3 flux = vec3(imageLoad(flux_image, ivec3(texel, layer)).x, imageLoad(flux_image, ivec3(texel, layer + 1)).x,
                   imageLoad(flux_image, ivec3(texel, layer + 2)).x);
  float per_area = push.watts / texelArea(s, vec2(texel) + 0.5, vec2(push.size));
  found.irradiance = flux * per_area;
  if (kHasDirections)
    found.direction = per_area * vec3(imageLoad(flux_image, ivec3(texel, layer + 3)).x,
                                      imageLoad(flux_image, ivec3(texel, layer + 4)).x,
                                      imageLoad(flux_image, ivec3(texel, layer + 5)).x);
  found.weight = 1.0;
  return found;
}

/// Between the four texels about a place, those that show other surfaces left out.
Found lookUp(uint v, vec2 texels, PixelSurface pixel, float reach) {
  Found sum = Found(vec3(0.0), vec3(0.0), 0.0);
  vec2 corner = floor(texels - 0.5), share = texels - 0.5 - corner;
  for (uint k = 0u; k < 4u; ++k) {
    vec2 step_k = vec2(k & 1u, k >> 1);
    vec2 at = clamp(corner + step_k, vec2(0.0), vec2(push.size) - 1.0);
    float weight = (step_k.x > 0.0 ? share.x : 1.0 - share.x) * (step_k.y > 0.0 ? share.y : 1.0 - share.y);
    Found found = fetchFlux(ivec2(at), v, pixel, reach);
    sum.irradiance += weight * found.irradiance;
    sum.direction += weight * found.direction;
    sum.weight += weight * found.weight;
  }
  return sum;
}

bool hasFlux(vec2 texels, uint v) {
  vec2 last = vec2(push.size) - 1.0;
  ivec2 first_tile = ivec2(clamp(texels - 1.0, vec2(0.0), last)) / int(kDepositTile);
  ivec2 last_tile = ivec2(clamp(texels + 1.0, vec2(0.0), last)) / int(kDepositTile);
  uint flags = imageLoad(tile_image, ivec3(first_tile, v)).x | imageLoad(tile_image, ivec3(last_tile, v)).x;
  flags |= imageLoad(tile_image, ivec3(first_tile.x, last_tile.y, v)).x;
  return (flags | imageLoad(tile_image, ivec3(last_tile.x, first_tile.y, v)).x) != 0u;
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  ivec2 picture = imageSize(irradiance_image);
  if (at.x >= picture.x || at.y >= picture.y) return;
  PixelSurface pixel;
  if (!surfaceOfPixel(at, picture, pixel)) return;
  vec2 size = vec2(push.size);
  uint v = kViewCount;
  OnPicture on;
  [[unroll]] for (uint i = 0u; i < kViewCount; ++i) {
    OnPicture here = onPicture(projectionOf(i), pixel.position, size);
    if (!isOnPicture(here, size)) continue;
    on = here;
    v = i;
  }
  if (v == kViewCount || !hasFlux(on.texels, v)) return;
  float reach = texelSize(on.w, size) + pixel.position_error;
  Found found = lookUp(v, on.texels, pixel, reach);
  if (found.weight <= 0.0) return;
  vec3 irradiance = found.irradiance / found.weight;
  imageStore(irradiance_image, at, imageLoad(irradiance_image, at) + vec4(irradiance, 0.0));
  if (!kHasDirections) return;
  vec4 direction = vec4(found.direction / found.weight, dot(irradiance, vec3(0.2126, 0.7152, 0.0722)));
  imageStore(direction_image, at, imageLoad(direction_image, at) + direction);
}
