// Light that comes straight from the lights to a point, shadows included.
//
// Shadows have the edges of the triangles: each point asks, with the very ray, the triangles that the light's grid
// lists for it (light_grid.comp.glsl). No bias, no resolution, no map.
//
// Needs, at the bindings that the including shader gives by NEPHROID_LIGHT_BINDINGS and the three numbers after it:
// the table of lights, the heads and the nodes of their grids, and the lights again as a buffer.
#ifndef NEPHROID_LIGHTS_GLSL
#define NEPHROID_LIGHTS_GLSL

#include "frame/response.glsl"
#include "core/optics/lights.shared.h"
#include "frame/cube.shared.h"

layout(set = 0, binding = NEPHROID_LIGHT_BINDINGS) uniform usamplerBuffer light_table;
layout(set = 0, binding = NEPHROID_LIGHT_BINDINGS + 1) uniform usamplerBuffer grid_heads;
layout(set = 0, binding = NEPHROID_LIGHT_BINDINGS + 2) uniform usamplerBuffer grid_nodes;
// Not uniforms: lights of a size are another each sample, and lavapipe would compile what depends on them each time.
layout(scalar, set = 0, binding = NEPHROID_LIGHT_BINDINGS + 3) readonly buffer Lights { LightRecord light_records[]; };

// How many lights there are, if they are few; else 0.
layout(constant_id = 12) const uint kFewLights = 0u;
/// The lights, if they are few, for places in a shader that ask for one whose index is a constant.
LightRecord lights[kMostFewLights];
/// To be called before threads may go different ways: there each word is read once, and not by every thread.
void fetchFewLights() {
  [[unroll]] for (uint i = 0u; i < kFewLights; ++i) lights[i] = light_records[i];
}

// What lights the scene has: the rest is left out.
layout(constant_id = 13) const bool kLightsHavePoints = true;       // with cubes of views
layout(constant_id = 14) const bool kLightsHaveDirectionals = true;
layout(constant_id = 15) const bool kLightsHaveSpots = true;
layout(constant_id = 16) const bool kLightsHaveSurfaces = true;

LightRecord fetchLight(uint i) {
  uvec4 zero = uvec4(0u), normal = zero;
  uvec4 position = texelFetch(light_table, int(7u * i));
  vec4 direction = uintBitsToFloat(texelFetch(light_table, int(7u * i + 1u)));
  vec4 value = uintBitsToFloat(texelFetch(light_table, int(7u * i + 2u)));
  if (kLightsHaveSurfaces) normal = texelFetch(light_table, int(7u * i + 3u));
  uvec4 grid = texelFetch(light_table, int(7u * i + 4u)), row_x = zero, row_y = zero;
  if (kLightsHaveDirectionals) {
    row_x = texelFetch(light_table, int(7u * i + 5u));
    row_y = texelFetch(light_table, int(7u * i + 6u));
  }
  return LightRecord(uintBitsToFloat(position.xyz), position.w, direction.xyz, direction.w, value.xyz, value.w,
                     uintBitsToFloat(normal.xyz), normal.w, grid.x, grid.y, grid.z, grid.w, uintBitsToFloat(row_x),
                     uintBitsToFloat(row_y));
}

struct Arriving {
  vec3 irradiance;  // on a surface that faces it, W/m²
  vec3 dir;         // unit, to the light
  float distance;   // m
};

Arriving arriveFrom(LightRecord light, vec3 position) {
  Arriving a;
  if (!kLightsHavePoints || (kLightsHaveDirectionals && light.kind == kLightDirectional)) {
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
  if (kLightsHaveSpots && light.kind == kLightSpot)
    intensity *= spotFalloff(-dot(a.dir, light.direction), light.cos_inner, light.cos_outer);
  if (kLightsHaveSurfaces) {
    float cos_surface = -dot(a.dir, light.normal);
    if (light.surface == kSurfaceFront) intensity *= max(cos_surface, 0.0);
    if (light.surface == kSurfaceBoth) intensity *= abs(cos_surface);
  }
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

uint fetchHead(uint list) { return texelFetch(grid_heads, int(list)).x; }

GridNode fetchNode(uint i) {
  uvec4 a = texelFetch(grid_nodes, int(3u * i));
  uvec4 b = texelFetch(grid_nodes, int(3u * i + 1u));
  uvec4 c = texelFetch(grid_nodes, int(3u * i + 2u));
  return GridNode(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz), c.w);
}

/// @param heads  of the lists to walk through
Shadow walkLists(uvec2 heads, Place place, Arriving light) {
  Shadow shadow = Shadow(uvec3(0u), false);
  bool second = heads.x == kNowhere;
  uint next = second ? heads.y : heads.x;
  // Whether there is more is asked at the end: a device that runs all branches runs a loop's body once more to find that
  // it is done. So both lists may be empty at the beginning, and then the first node there is is read in vain.
  bool is_node = next != kNowhere;
  next = is_node ? next : 0u;
  do {
    GridNode node = fetchNode(next);
    bool own = (node.instance & ~kNodePassable) == place.instance && node.triangle == place.triangle;
    RayTriangle hit = intersectPlaneOf(Triangle(node.a, node.b, node.c), place.start, light.dir);
    if (is_node && !own && isInside(hit) && hit.t > 0.0 && hit.t < light.distance * (1.0 - 1e-5) * hit.size) {
      if (kSceneHasPassable && (node.instance & kNodePassable) != 0u) {
        if (hasEdges(node, hit)) shadow = passThrough(shadow, node, hit.u / hit.size, hit.v / hit.size, light.dir);
      } else {
        shadow.blocked = true;
      }
    }
    next = is_node ? node.next : kNowhere;
    if (next == kNowhere && !second) {
      second = true;
      next = heads.y;
    }
  } while (next != kNowhere && !shadow.blocked);
  return shadow;
}

/// The cell of a light's grid that a point lies in: 14 bits of its column, 14 of its row, and the view; kNowhere where
/// the point is the light's own.
uint cellOnGrid(LightRecord light, vec3 position) {
  float size = float(light.grid_size);
  uint face = 0u;
  vec2 on_grid;
  bool valid = true;
  if (!kLightsHavePoints || (kLightsHaveDirectionals && light.kind == kLightDirectional)) {
    vec4 p = vec4(position, 1.0);
    on_grid = vec2(dot(light.grid_row_x, p), dot(light.grid_row_y, p));
  } else {
    CubePlace on_cube = placeOnCube(position - light.position);
    valid = on_cube.depth > 0.0;
    face = on_cube.face;
    on_grid = vec2(on_cube.x, on_cube.y) * (0.5 * size / on_cube.depth) + 0.5 * size;
  }
  uvec2 cell = uvec2(clamp(floor(on_grid), vec2(0.0), vec2(size - 1.0)));
  return valid ? cell.x | (cell.y << 14) | (face << 28) : kNowhere;
}

/// Heads of the lists of a light's grid that hold what may lie between the points of a cell and the light.
struct GridLists {
  uint fine;
  uint coarse;
  uint mark;  // where it says whether any list of a fine cell in the coarse one holds something: kNowhere if none does
};

GridLists listsOf(LightRecord light, uint cell) {
  uvec2 place = uvec2(cell & 0x3FFFu, cell >> 14 & 0x3FFFu);
  uint face = cell >> 28, size = light.grid_size, coarse_size = size / kCoarseCell;
  uint coarse = light.first_head + light.view_count * size * size +
                (face * coarse_size + place.y / kCoarseCell) * coarse_size + place.x / kCoarseCell;
  return GridLists(light.first_head + (face * size + place.y) * size + place.x, coarse,
                   coarse + light.view_count * coarse_size * coarse_size);
}

/// Share of the light that reaches a point.
vec3 visibilityOf(uint light_index, LightRecord light, Place place, Arriving arriving, vec3 position) {
  uint cell = cellOnGrid(light, position);
  if (cell == kNowhere) return vec3(1.0);
  GridLists lists = listsOf(light, cell);
  uvec2 heads = uvec2(fetchHead(lists.fine), fetchHead(lists.coarse));
  Shadow shadow = walkLists(heads, place, arriving);
  if (shadow.blocked) return vec3(0.0);
  return kSceneHasPassable ? exp2(vec3(shadow.octaves) / -kOctave) : vec3(1.0);
}

/// Is a plane turned towards light that arrives, and is there any?
bool mayReach(LightRecord light, vec3 normal, Arriving arriving) {
  return light.view_count != 0u && dot(arriving.dir, normal) > 0.0 &&
         max(arriving.irradiance.x, max(arriving.irradiance.y, arriving.irradiance.z)) > 0.0;
}

/// The same of a surface, whose shaded normal counts too.
bool isReached(LightRecord light, Surface s, Arriving arriving) {
  return mayReach(light, s.geometric, arriving) && dot(arriving.dir, s.shading) > 0.0;
}

/// Where shadows are asked from.
Place placeOf(Surface s) {
  return Place(s.position + s.position_error * s.geometric, s.instance_index, s.triangle);
}

/// Radiance towards the eye of light that nothing keeps from a surface that it reaches, W/m²/sr.
vec3 radianceUnshadowed(Surface s, MaterialPoint m, vec3 wo, Arriving arriving, float specular_alpha) {
  return respond(s, m, wo, arriving.dir, specular_alpha) * arriving.irradiance * dot(arriving.dir, s.shading);
}

/// Radiance towards the eye of what comes straight from one light, W/m²/sr.
/// @param s   its shading normal perturbed; both normals on the side of the eye
/// @param wo  unit, to the eye
vec3 lightFrom(uint light_index, LightRecord light, Surface s, MaterialPoint m, vec3 wo, float specular_alpha) {
  Arriving arriving = arriveFrom(light, s.position);
  if (!isReached(light, s, arriving)) return vec3(0.0);
  return radianceUnshadowed(s, m, wo, arriving, specular_alpha) *
         visibilityOf(light_index, light, placeOf(s), arriving, s.position);
}

vec3 lightFrom(uint light_index, Surface s, MaterialPoint m, vec3 wo, float specular_alpha) {
  return lightFrom(light_index, fetchLight(light_index), s, m, wo, specular_alpha);
}

/// The sum over all lights, which are `light_count`.
vec3 lightFromAll(uint light_count, Surface s, MaterialPoint m, vec3 wo, float specular_alpha) {
  vec3 sum = vec3(0.0);
  if (kFewLights > 0u) {
    [[unroll]] for (uint i = 0u; i < kFewLights; ++i) sum += lightFrom(i, lights[i], s, m, wo, specular_alpha);
  } else {
    for (uint i = 0u; i < light_count; ++i) sum += lightFrom(i, s, m, wo, specular_alpha);
  }
  return sum;
}

#endif
