// Light that comes straight from the lights to a point, shadows included.
//
// Shadows have the edges of the triangles: each point asks, with the very ray, the triangles that the light's grid
// lists for it (light_grid.comp.glsl). No bias, no resolution, no map.
//
// Needs, at the bindings that the including shader gives by NEPHROID_LIGHT_BINDINGS and the three numbers after it:
// the tables of lights and their views, the heads and the nodes of their grids.
#ifndef NEPHROID_LIGHTS_GLSL
#define NEPHROID_LIGHTS_GLSL

#include "frame/material.glsl"
#include "core/optics/lights.shared.h"

layout(set = 0, binding = NEPHROID_LIGHT_BINDINGS) uniform usampler2D light_table;
layout(set = 0, binding = NEPHROID_LIGHT_BINDINGS + 1) uniform usampler2D view_table;
layout(set = 0, binding = NEPHROID_LIGHT_BINDINGS + 2) uniform usampler2DArray grid_heads;  // a layer a light
layout(set = 0, binding = NEPHROID_LIGHT_BINDINGS + 3) uniform usampler2D grid_nodes;

LightRecord fetchLight(uint i) {
  uvec4 position = texelFetch(light_table, texelOf(5u * i), 0);
  vec4 direction = uintBitsToFloat(texelFetch(light_table, texelOf(5u * i + 1u), 0));
  vec4 value = uintBitsToFloat(texelFetch(light_table, texelOf(5u * i + 2u), 0));
  uvec4 normal = texelFetch(light_table, texelOf(5u * i + 3u), 0);
  uvec4 views = texelFetch(light_table, texelOf(5u * i + 4u), 0);
  return LightRecord(uintBitsToFloat(position.xyz), position.w, direction.xyz, direction.w, value.xyz, value.w,
                     uintBitsToFloat(normal.xyz), normal.w, views.x, views.y, views.z, views.w);
}

struct Arriving {
  vec3 irradiance;  // on a surface that faces it, W/m²
  vec3 dir;         // unit, to the light
  float distance;   // m
};

Arriving arriveFrom(LightRecord light, vec3 position) {
  Arriving a;
  if (light.kind == kLightDirectional) {
    a.dir = -light.direction;
    a.distance = kFarAway;
    a.irradiance = light.value;
    return a;
  }
  vec3 to_light = light.position - position;
  float squared = max(dot(to_light, to_light), 1e-37);
  float inverse = inversesqrt(squared);
  a.distance = squared * inverse;
  a.dir = to_light * inverse;
  vec3 intensity = light.value;
  if (light.kind == kLightSpot) intensity *= spotFalloff(-dot(a.dir, light.direction), light.cos_inner, light.cos_outer);
  float cos_surface = -dot(a.dir, light.normal);
  if (light.surface == kSurfaceFront) intensity *= max(cos_surface, 0.0);
  if (light.surface == kSurfaceBoth) intensity *= abs(cos_surface);
  a.irradiance = intensity * (inverse * inverse);
  return a;
}

/// The surface that a shadow is asked for.
struct Place {
  vec3 start;     // a hair off the surface, towards the light
  uint instance;  // its own triangle does not shadow it
  uint triangle;
};

/// How much light is let through, as steps of 2^-20 octaves: a sum of whole numbers is the same in any order, and that
/// of a list differs between runs.
struct Shadow {
  uvec3 octaves;
  bool blocked;
};

const float kOctave = 1048576.0;

Shadow passThrough(Shadow shadow, GridNode node, float u, float v, vec3 dir) {
  InstanceRecord instance = fetchInstance(node.instance & ~kNodePassable);
  MaterialPoint material = materialAt(instance, node.triangle, u, v);
  Surface surface = surfaceAt(node.instance & ~kNodePassable, node.triangle, instance,
                              fetchTriangle(instance.first_triangle + node.triangle), Triangle(node.a, node.b, node.c),
                              u, v);
  surface.shading = perturbedNormal(surface);
  vec3 pass = passTransmittance(material, abs(dot(dir, surface.shading)));
  if (max(pass.x, max(pass.y, pass.z)) <= 0.0) shadow.blocked = true;
  // Less than 2^-100 is as good as nothing.
  shadow.octaves += uvec3(round(clamp(-log2(max(pass, vec3(1e-30))), vec3(0.0), vec3(100.0)) * kOctave));
  return shadow;
}

bool isBefore(vec3 p, vec3 q) { return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z; }

/// Of two triangles that share the edge that a ray meets, one has it: else a pane would be passed twice there. They run
/// along it in opposite directions.
bool hasEdges(GridNode node, RayTriangle hit) {
  if (hit.v == 0.0 && !isBefore(node.a, node.b)) return false;
  if (hit.u + hit.v == hit.size && !isBefore(node.b, node.c)) return false;
  return hit.u != 0.0 || isBefore(node.c, node.a);
}

/// @param heads  of the lists to walk through
Shadow walkLists(uvec2 heads, Place place, Arriving light) {
  Shadow shadow = Shadow(uvec3(0u), false);
  uint next = heads.x;
  bool second = false;
  while (!shadow.blocked) {
    if (next == kNowhere && !second) {
      second = true;
      next = heads.y;
    }
    if (next == kNowhere) break;
    uvec4 a = texelFetch(grid_nodes, texelOf(3u * next), 0);
    uvec4 b = texelFetch(grid_nodes, texelOf(3u * next + 1u), 0);
    uvec4 c = texelFetch(grid_nodes, texelOf(3u * next + 2u), 0);
    next = a.w;
    GridNode node =
        GridNode(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz), c.w);
    bool own = (node.instance & ~kNodePassable) == place.instance && node.triangle == place.triangle;
    RayTriangle hit = intersectPlaneOf(Triangle(node.a, node.b, node.c), place.start, light.dir);
    if (own || !isInside(hit) || hit.t <= 0.0 || hit.t >= light.distance * (1.0 - 1e-5) * hit.size) continue;
    if (kSceneHasPassable && (node.instance & kNodePassable) != 0u) {
      if (hasEdges(node, hit)) shadow = passThrough(shadow, node, hit.u / hit.size, hit.v / hit.size, light.dir);
    } else {
      shadow.blocked = true;
    }
  }
  return shadow;
}

uint chooseFace(vec3 v) {
  vec3 a = abs(v);
  if (a.x >= a.y && a.x >= a.z) return v.x >= 0.0 ? 0u : 1u;
  if (a.y >= a.z) return v.y >= 0.0 ? 2u : 3u;
  return v.z >= 0.0 ? 4u : 5u;
}

ivec3 headOf(uint list, uint light) {
  return ivec3(list & ((1u << kHeadsShift) - 1u), list >> kHeadsShift, light);
}

/// Share of the light that reaches a point.
vec3 visibilityOf(uint light_index, LightRecord light, Place place, Arriving arriving, vec3 position) {
  uint face = light.view_count == 6u ? chooseFace(position - light.position) : 0u;
  uint view = 8u * (light.first_view + face);
  vec4 p = vec4(position, 1.0);
  float x = dot(uintBitsToFloat(texelFetch(view_table, texelOf(view), 0)), p);
  float y = dot(uintBitsToFloat(texelFetch(view_table, texelOf(view + 1u), 0)), p);
  float w = dot(uintBitsToFloat(texelFetch(view_table, texelOf(view + 3u), 0)), p);
  if (w <= 0.0) return vec3(1.0);
  float size = float(light.grid_size);
  vec2 on_grid = vec2(x, y) * (0.5 * size / w) + 0.5 * size;
  uvec2 cell = uvec2(clamp(floor(on_grid), vec2(0.0), vec2(size - 1.0)));
  uint coarse_size = light.grid_size / kCoarseCell;
  uvec2 coarse = cell / kCoarseCell;
  uint fine_list = (face * light.grid_size + cell.y) * light.grid_size + cell.x;
  uint coarse_list = light.view_count * light.grid_size * light.grid_size +
                     (face * coarse_size + coarse.y) * coarse_size + coarse.x;
  uvec2 heads = uvec2(texelFetch(grid_heads, headOf(fine_list, light_index), 0).x,
                      texelFetch(grid_heads, headOf(coarse_list, light_index), 0).x);
  Shadow shadow = walkLists(heads, place, arriving);
  if (shadow.blocked) return vec3(0.0);
  return kSceneHasPassable ? exp2(vec3(shadow.octaves) / -kOctave) : vec3(1.0);
}

/// Radiance towards the eye of what comes straight from one light, W/m²/sr.
/// @param s   its shading normal perturbed; both normals on the side of the eye
/// @param wo  unit, to the eye
vec3 lightFrom(uint light_index, Surface s, MaterialPoint m, vec3 wo, float specular_alpha) {
  LightRecord light = fetchLight(light_index);
  if (light.view_count == 0u) return vec3(0.0);
  Arriving arriving = arriveFrom(light, s.position);
  float cos_light = dot(arriving.dir, s.shading);
  if (cos_light <= 0.0 || dot(arriving.dir, s.geometric) <= 0.0) return vec3(0.0);
  if (max(arriving.irradiance.x, max(arriving.irradiance.y, arriving.irradiance.z)) <= 0.0) return vec3(0.0);
  vec3 brdf;
  if (kSceneHasMetal || kSceneHasGloss) {
    vec3 across = abs(s.shading.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 tangent = normalize(cross(s.shading, across));
    vec3 bitangent = cross(s.shading, tangent);
    brdf = evaluateReceiver(m.optics, vec3(dot(wo, tangent), dot(wo, bitangent), dot(wo, s.shading)),
                            vec3(dot(arriving.dir, tangent), dot(arriving.dir, bitangent), cos_light), specular_alpha);
  } else {
    brdf = evaluateBase(baseScale(m.optics), vec3(1.0), vec3(1.0));
  }
  Place place = Place(s.position + s.position_error * s.geometric, s.instance_index, s.triangle);
  return brdf * arriving.irradiance * cos_light * visibilityOf(light_index, light, place, arriving, s.position);
}

#endif
