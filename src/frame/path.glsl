// Paths that mirrors, glass and water lead on, surface by surface: from the eye or from a light.
//
// The including shader declares before: max_events, the most events of class S in a row.
#ifndef NEPHROID_PATH_GLSL
#define NEPHROID_PATH_GLSL

#include "frame/interior.glsl"
#include "frame/material.glsl"
#include "core/optics/absorption.shared.h"
#include "core/optics/dispersion.shared.h"
#include "frame/specular_lobe.glsl"

layout(constant_id = 9) const bool kSceneTransmits = true;
layout(constant_id = 10) const bool kSceneHasMedia = true;  // that absorb
layout(constant_id = 11) const bool kSceneDisperses = true;

/// A path on its way.
struct Path {
  Ray ray;
  vec3 throughput;  // of a path from a light: its flux, W
  bool branched;  // past the first surface that could be seen both ways
  bool ended;
  uint events;
  uint seed;            // of the next chance
  float wavelength_nm;  // 0 until something dispersive was met
  uint instance;        // on which the ray starts
  uint triangle;
  Interior interior;
};

/// A surface that a ray meets.
struct Met {
  float t;  // kFarAway: nothing
  float u;  // weights of the second and third corner
  float v;
  uint instance;  // kNowhere: nothing
  uint triangle;
};

float draw(inout Path path) {
  path.seed = hashChain(path.seed, 1u);
  return float(path.seed >> 8) / 16777216.0;
}

float largest(vec3 v) { return max(v.x, max(v.y, v.z)); }
float luminanceOf(vec3 rgb) { return dot(rgb, vec3(0.2126, 0.7152, 0.0722)); }

vec3 transmittanceOf(uint material, float distance) {
  return kSceneHasMedia ? transmittance(fetchMedium(material).sigma_a, distance) : vec3(1.0);
}

float iorOf(Medium medium, float wavelength_nm) {
  if (!kSceneDisperses || medium.dispersion == 0.0 || wavelength_nm == 0.0) return medium.ior;
  return dispersiveIor(medium.ior, medium.dispersion, wavelength_nm);
}

Surface surfaceMet(uint instance_index, uint triangle, float u, float v) {
  InstanceRecord instance = fetchInstance(instance_index);
  TriangleRecord record = fetchTriangle(instance.first_triangle + triangle);
  Surface s = surfaceAt(instance_index, triangle, instance, record, toWorld(instance, record), u, v);
  return s;
}

/// With its normal map, both normals to where the ray comes from.
Surface turnTowards(Surface s, vec3 dir) {
  if (kSceneHasTextures) s.shading = perturbedNormal(s);
  turnTo(s, dir);
  return s;
}

Ray startFrom(Surface s, vec3 dir) {
  float side = dot(s.geometric, dir) >= 0.0 ? s.position_error : -s.position_error;
  return Ray(s.position + side * s.geometric, dir);
}

/// What is shown of a pixel's first surface.
Met metSeen(Ray ray, uvec2 seen) {
  InstanceRecord instance = fetchInstance(seen.x - 1u);
  Triangle corners = toWorld(instance, fetchTriangle(instance.first_triangle + seen.y));
  vec3 weights = weightsOn(corners, ray);
  vec3 place = corners.a + weights.y * (corners.b - corners.a) + weights.z * (corners.c - corners.a);
  return Met(dot(place - ray.origin, ray.dir), weights.y, weights.z, seen.x - 1u, seen.y);
}

/// A way on from an interface.
struct Way {
  vec3 dir;
  vec3 weight;   // of the radiance that comes along it; 0: there is none
  bool through;  // to the other side
};

/// Light must be on the same side of the true and the shaded surface, else it leaks through.
Way reflection(Scattered scattered, Surface s) {
  bool leaks = dot(scattered.reflected, s.geometric) <= 0.0;
  return Way(scattered.reflected, leaks ? vec3(0.0) : scattered.reflected_weight, false);
}
Way transmission(Scattered scattered, Surface s) {
  bool leaks = dot(scattered.transmitted, s.geometric) > 0.0;
  return Way(scattered.transmitted, leaks ? vec3(0.0) : scattered.transmitted_weight, true);
}

/// The solid whose boundary a chain meets, if it is one.
struct Crossing {
  bool is_solid;
  bool entering;
  Interior entered;  // what the chain is inside of if it enters, and if it leaves
  Interior left;
};

/// Goes on along a way.
void take(inout Path path, Way way, Surface s, Crossing crossing, bool is_smooth_pane) {
  path.throughput *= way.weight;
  path.events += way.through && is_smooth_pane ? 0u : 1u;
  path.ended = largest(abs(path.throughput)) == 0.0 || path.events >= max_events;
  path.ray = startFrom(s, way.dir);
  if (!kSceneTransmits || !crossing.is_solid) return;
  // Mirrored inside of a solid that was not listed: it is now known to be inside.
  bool listed = contains(path.interior, s.instance.solid);
  bool enters = way.through ? crossing.entering : !crossing.entering && !listed;
  if (enters && isFull(path.interior)) path.ended = true;
  if (enters) path.interior = crossing.entered;
  if (way.through && !crossing.entering) path.interior = crossing.left;
}

/// Goes straight on, through a hole or the boundary of a solid that another one rules.
void passOn(inout Path path, Surface s, Crossing crossing) {
  path.ray = startFrom(s, path.ray.dir);
  if (!kSceneTransmits || !crossing.is_solid) return;
  if (crossing.entering && isFull(path.interior)) path.ended = true;
  path.interior = crossing.entering ? crossing.entered : crossing.left;
}

/// What a path finds at a surface, and what it then is inside of.
struct Encounter {
  Surface surface;  // both normals on the side that the path comes from
  MaterialPoint material;
  Boundary boundary;
  Crossing crossing;
};

/// Follows the path to the surface: what lies on the way absorbs.
/// @param emission_seen  whether the side that is met is the one that shines
Encounter encounter(inout Path path, Met met, out bool emission_seen) {
  Encounter e;
  e.surface = surfaceMet(met.instance, met.triangle, met.u, met.v);
  e.material = materialAt(e.surface.instance, e.surface.triangle, e.surface.u, e.surface.v);
  InstanceRecord instance = e.surface.instance;
  bool is_solid = kSceneTransmits && e.material.optics.is_solid != 0u;
  bool entering = dot(path.ray.dir, e.surface.geometric) < 0.0;
  uint inside = mediumOf(path.interior, kNowhere);
  e.boundary = Boundary(inside, inside, true);
  e.crossing = Crossing(is_solid, entering, path.interior, path.interior);
  if (is_solid) {
    int priority = fetchMedium(instance.material).priority;
    e.boundary = boundaryAt(path.interior, instance.solid, instance.material, priority, entering);
    e.crossing.entered = enter(path.interior, instance.solid, instance.material, priority);
    e.crossing.left = leave(path.interior, instance.solid);
    // Met from the inside without having entered: the way here was inside.
    if (!entering && !contains(path.interior, instance.solid)) inside = instance.material;
  }
  path.instance = met.instance;
  path.triangle = met.triangle;
  path.throughput *= transmittanceOf(inside, met.t);
  emission_seen = entering || e.material.double_sided;
  e.surface = turnTowards(e.surface, path.ray.dir);
  return e;
}

#endif
