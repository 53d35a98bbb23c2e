// What one view of a light adds to `direct`: light that comes straight from it to the surface of each pixel.
//
// Shadows have the edges of the triangles: each point asks, with the very ray, the triangles that the light's grid
// lists for it. No bias, no resolution, no map.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/scene_access.glsl"
#include "core/optics/lights.shared.h"
#include "core/optics/surface.shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 5) readonly buffer EyeViews { ViewRecord eye_views[]; };
layout(scalar, set = 0, binding = 6) readonly buffer LightViews { ViewRecord light_views[]; };
layout(scalar, set = 0, binding = 7) readonly buffer Lights { LightRecord lights[]; };
layout(scalar, set = 0, binding = 8) readonly buffer Heads { uint heads[]; };
layout(scalar, set = 0, binding = 9) readonly buffer Nodes { GridNode nodes[]; };
layout(set = 0, binding = 10, rgba32f) readonly uniform image2D position_image;
layout(set = 0, binding = 11, rgba32ui) readonly uniform uimage2D surface_image;
layout(set = 0, binding = 12, rgba32f) uniform image2D direct_image;  // sum over samples, W/m²/sr

layout(push_constant, scalar) uniform Push { float specular_alpha; };
// What no material of the scene has is not compiled: a device that runs all branches for all threads pays for each.
layout(constant_id = 0) const bool kSceneHasMetal = true;
layout(constant_id = 1) const bool kSceneHasGloss = true;
layout(constant_id = 2) const bool kSceneHasConductors = true;

struct Arriving {
  vec3 irradiance;  // on a surface that faces it, W/m²
  vec3 dir;         // unit, to the light
  float distance;   // m
};

Arriving arriveFrom(LightRecord light, vec3 position) {
  Arriving a;
  if (light.kind == kLightDirectional) {
    a.dir = -light.direction;
    a.distance = 3.4e38;
    a.irradiance = light.value;
    return a;
  }
  vec3 to_light = light.position - position;
  float squared = dot(to_light, to_light);
  a.distance = sqrt(squared);
  a.dir = squared > 0.0 ? to_light / a.distance : vec3(0.0, 1.0, 0.0);
  vec3 intensity = light.value;
  if (light.kind == kLightSpot) intensity *= spotFalloff(-dot(a.dir, light.direction), light.cos_inner, light.cos_outer);
  float cos_surface = -dot(a.dir, light.normal);
  if (light.surface == kSurfaceFront) intensity *= max(cos_surface, 0.0);
  if (light.surface == kSurfaceBoth) intensity *= abs(cos_surface);
  a.irradiance = squared > 0.0 ? intensity / squared : vec3(0.0);
  return a;
}

uint chooseFace(vec3 v) {
  vec3 a = abs(v);
  if (a.x >= a.y && a.x >= a.z) return v.x >= 0.0 ? 0u : 1u;
  if (a.y >= a.z) return v.y >= 0.0 ? 2u : 3u;
  return v.z >= 0.0 ? 4u : 5u;
}

/// The surface that the shadow is asked for.
struct Place {
  vec3 start;     // a hair off the surface, towards the light
  uint instance;  // its own triangle does not shadow it
  uint triangle;
};

bool isBlockedBy(uint list, Place place, Arriving light) {
  for (uint node = heads[list]; node != kNoNode;) {
    GridNode entry = nodes[node];
    node = entry.next;
    if (entry.instance == place.instance && entry.triangle == place.triangle) continue;
    RayTriangle hit = intersectPlaneOf(Triangle(entry.a, entry.b, entry.c), place.start, light.dir);
    if (isInside(hit) && hit.t > 0.0 && hit.t < light.distance * (1.0 - 1e-5)) return true;
  }
  return false;
}

bool isBlocked(LightRecord light, Place place, Arriving arriving, vec3 position) {
  uint cells = uint(light.grid_size * light.grid_size);
  if (isBlockedBy(light.view_count * cells, place, arriving)) return true;
  uint face = light.view_count == 6u ? chooseFace(position - light.position) : 0u;
  ViewRecord view = light_views[face];
  vec4 p = vec4(position, 1.0);
  float w = dot(view.clip_row_w, p);
  if (w <= 0.0) return false;
  vec2 ndc = vec2(dot(view.clip_row_x, p), dot(view.clip_row_y, p)) / w;
  vec2 cell = clamp(floor((ndc * 0.5 + 0.5) * light.grid_size), vec2(0.0), vec2(light.grid_size - 1.0));
  return isBlockedBy(face * cells + uint(cell.y * light.grid_size + cell.x), place, arriving);
}

SurfaceOptics opticsOf(MaterialRecord m) {
  SurfaceOptics s;
  s.base = m.base;
  s.metallic = m.metallic;
  s.alpha = m.alpha;
  s.transmission = m.transmission;
  s.gloss = m.gloss;
  s.specular_tint = m.specular_tint;
  s.ior_from = 1.0;
  s.ior_to = m.ior;
  s.average_fresnel = m.average_fresnel;
  s.conductor_ior = m.conductor_ior;
  s.conductor_k = m.conductor_k;
  s.has_conductor = (m.flags & kMaterialHasConductor) != 0u ? 1u : 0u;
  if (!kSceneHasMetal) s.metallic = 0.0;
  if (!kSceneHasGloss) s.gloss = 0.0;
  if (!kSceneHasConductors) s.has_conductor = 0u;
  s.is_pane = (m.flags & kMaterialIsPane) != 0u ? 1u : 0u;
  s.is_solid = (m.flags & kMaterialIsSolid) != 0u ? 1u : 0u;
  return s;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(position_image);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  uvec4 surface = imageLoad(surface_image, pixel);
  if (surface.x == 0u) return;
  MaterialRecord material = materials[instances[surface.x - 1u].material];
  SurfaceOptics optics = opticsOf(material);
  bool has_base = material.metallic < 1.0 && material.transmission < 1.0;
  bool has_interface = optics.alpha >= specular_alpha && (kSceneHasMetal || kSceneHasGloss);
  if (!has_base && !has_interface) return;

  vec4 position_error = imageLoad(position_image, pixel);
  vec3 position = position_error.xyz;
  vec3 geometric = unpackUnit(surface.z), shading = unpackUnit(surface.w);
  vec3 wo = dirToEye(eye_views[0], position);
  if (dot(wo, geometric) < 0.0) {
    geometric = -geometric;
    shading = -shading;
  }
  // Near a silhouette the interpolated normal may look away from the eye: the true one cannot.
  if (dot(shading, wo) <= 1e-4) shading = geometric;

  LightRecord light = lights[0];
  Arriving arriving = arriveFrom(light, position);
  float cos_light = dot(arriving.dir, shading);
  if (cos_light <= 0.0 || dot(arriving.dir, geometric) <= 0.0) return;
  if (max(arriving.irradiance.x, max(arriving.irradiance.y, arriving.irradiance.z)) <= 0.0) return;
  Place place = Place(position + position_error.w * geometric, surface.x - 1u, surface.y);
  if (isBlocked(light, place, arriving, position)) return;

  vec3 tangent = normalize(abs(shading.y) < 0.9 ? cross(shading, vec3(0.0, 1.0, 0.0)) : cross(shading, vec3(1.0, 0.0, 0.0)));
  vec3 bitangent = cross(shading, tangent);
  vec3 wo_local = vec3(dot(wo, tangent), dot(wo, bitangent), dot(wo, shading));
  vec3 wi_local = vec3(dot(arriving.dir, tangent), dot(arriving.dir, bitangent), cos_light);
  vec3 brdf = kSceneHasMetal || kSceneHasGloss ? evaluateReceiver(optics, wo_local, wi_local, specular_alpha)
                                               : evaluateBase(baseScale(optics), vec3(1.0), vec3(1.0));
  vec3 radiance = brdf * arriving.irradiance * cos_light;
  vec4 sum = imageLoad(direct_image, pixel);
  imageStore(direct_image, pixel, sum + vec4(radiance, 0.0));
}
