// What a light sends through the cells of a picture that it takes of the scene: emission on a grid, for C++ and GLSL.
#ifndef NEPHROID_EMISSION_SHARED_H
#define NEPHROID_EMISSION_SHARED_H

#include "core/optics/lights.shared.h"
#include "frame/frame.shared.h"

NEPHROID_NAMESPACE_BEGIN

/// From where and in which direction the ray of a place in a view's picture goes.
struct EmissionRay {
  vec3 origin;
  vec3 dir;  // unit
};

/// @param film_x, film_y  in [-1, 1], y down
NEPHROID_FN EmissionRay emissionRay(ViewRecord view, float film_x, float film_y) {
  vec3 across = film_x * view.right - film_y * view.up;
  EmissionRay ray;
  ray.origin = view.eye;
  ray.dir = view.forward;
  if (view.is_orthographic != 0u) {
    ray.origin = view.eye + across;
  } else {
    ray.dir = normalize(view.forward + across);
  }
  return ray;
}

/// Flux that a light sends through a cell, W: I·ω of a point or a spot, E⊥·A of parallel light, A measured across it. The
/// cosine to what it falls on is no factor: a cell is a beam, and how large its foot is does not change its flux. (Eq. 6
/// of [shah-caustics-mapping] has that factor; with a grid in the light's view it then counts twice.)
///
/// @param film_x, film_y  the cell's middle, in [-1, 1]
/// @param cell_share      of the picture's area
NEPHROID_FN vec3 cellFlux(LightRecord light, ViewRecord view, float film_x, float film_y, float cell_share) {
  // `right` and `up` are half of the picture's width and height.
  float area = 4.0f * length(view.right) * length(view.up) * cell_share;
  if (light.kind == kLightDirectional) return light.value * area;
  vec3 dir = emissionRay(view, film_x, film_y).dir;
  vec3 intensity = light.value;
  if (light.kind == kLightSpot)
    intensity = spotIntensity(intensity, light.direction, light.cos_inner, light.cos_outer, dir);
  float cos_surface = dot(dir, light.normal);
  if (light.surface == kSurfaceFront) intensity = intensity * max(cos_surface, 0.0f);
  if (light.surface == kSurfaceBoth) intensity = intensity * abs(cos_surface);
  return intensity * cellSolidAngle(film_x * length(view.right), film_y * length(view.up), area);
}

NEPHROID_NAMESPACE_END

#endif
