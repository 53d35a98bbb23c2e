// What a pixel shows: of the frame's own picture, or of images that somebody else drew.
//
// The including shader gives the five bindings from NEPHROID_PIXEL_BINDINGS on (frame/pixel_surfaces.h).
#ifndef NEPHROID_PIXEL_SURFACE_GLSL
#define NEPHROID_PIXEL_SURFACE_GLSL

#include "frame/surface.glsl"

layout(scalar, set = 0, binding = NEPHROID_PIXEL_BINDINGS) uniform PixelView { ViewRecord pixel_view; };
layout(scalar, set = 0, binding = NEPHROID_PIXEL_BINDINGS + 1) uniform PixelForeign {
  ForeignViewRecord pixel_foreign;
};
layout(set = 0, binding = NEPHROID_PIXEL_BINDINGS + 2, rg32ui) readonly uniform uimage2D pixel_seen;
layout(set = 0, binding = NEPHROID_PIXEL_BINDINGS + 3) uniform sampler2D pixel_depth;
layout(set = 0, binding = NEPHROID_PIXEL_BINDINGS + 4) uniform sampler2D pixel_normal;

layout(constant_id = 17) const bool kPixelsAreForeign = false;

/// A surface in a pixel; both normals on the side that is seen.
struct PixelSurface {
  vec3 position;         // world
  float position_error;  // across the surface, m
  vec3 geometric;        // unit
  vec3 shading;          // unit, textures not yet
  uint instance;         // kNowhere: of no instance that is known
  uint triangle;
};

vec3 placeOf(ForeignViewRecord view, vec4 clip) {
  vec3 p = vec3(dot(view.world_row_x, clip), dot(view.world_row_y, clip), dot(view.world_row_z, clip));
  return p / dot(view.world_row_w, clip);
}

/// How far off the plane a place may lie that comes from a depth: by the steps of the depths, and because a rasteriser
/// moves corners to a grid of 1/256 of a pixel.
float boundForeignError(ForeignViewRecord view, vec4 clip, vec2 pixel_size, vec3 position, vec3 normal) {
  float depth_step = max(view.depth_step, view.depth_ulp * clip.z);
  vec3 deeper = placeOf(view, clip + vec4(0.0, 0.0, depth_step, 0.0)) - position;
  vec3 beside = placeOf(view, clip + vec4(pixel_size, 0.0, 0.0) / 128.0) - position;
  return 2.0 * abs(dot(deeper, normal)) + length(beside) + kPositionErrorScale * dot(abs(normal), abs(position));
}

/// @return  false where there is nothing
bool surfaceOfForeign(ivec2 pixel, ivec2 size, out PixelSurface s) {
  ForeignViewRecord view = pixel_foreign;
  vec3 normal = texelFetch(pixel_normal, pixel, 0).xyz;
  if (view.normals_are_coded != 0u) normal = 2.0 * normal - 1.0;
  float squared = dot(normal, normal);
  vec2 pixel_size = 2.0 / vec2(size);
  vec4 clip = vec4((vec2(pixel) + 0.5) * pixel_size - 1.0, texelFetch(pixel_depth, pixel, 0).x, 1.0);
  s.position = placeOf(view, clip);
  s.geometric = s.shading = normal * inversesqrt(max(squared, 1e-12));
  s.position_error = boundForeignError(view, clip, pixel_size, s.position, s.geometric);
  s.instance = kNowhere;
  s.triangle = 0u;
  // A normal that is cleared to nothing, whether coded or not, is far shorter or longer than one.
  return squared > 0.25 && squared < 2.25;
}

bool surfaceOfPixel(ivec2 pixel, ivec2 size, out PixelSurface s) {
  if (kPixelsAreForeign) return surfaceOfForeign(pixel, size, s);
  uvec2 seen = imageLoad(pixel_seen, pixel).xy;
  if (seen.x == 0u) return false;
  ViewRecord view = pixel_view;
  Ray ray = rayThrough(view, (vec2(pixel) + vec2(view.film_x, view.film_y)) / vec2(size) * 2.0 - 1.0);
  Surface full = surfaceSeen(ray, seen.x - 1u, seen.y);
  float side = dot(ray.dir, full.geometric) < 0.0 ? 1.0 : -1.0;
  s = PixelSurface(full.position, full.position_error, side * full.geometric, side * full.shading, full.instance_index,
                   full.triangle);
  return true;
}

#endif
