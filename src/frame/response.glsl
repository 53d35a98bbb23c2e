// What a receiver makes of light from one direction.
#ifndef NEPHROID_RESPONSE_GLSL
#define NEPHROID_RESPONSE_GLSL

#include "frame/material.glsl"

/// Some receiver has a lobe besides its base, or a base that an interface covers. Of paths that cross glass as well,
/// kSceneHasGloss says less.
layout(constant_id = 19) const bool kReceiversHaveLobes = true;

/// All lobes of class D, 1/sr, without the cosine.
/// @param s       its shading normal on the side of the eye
/// @param wo, wi  unit, to the eye and to the light
vec3 respond(Surface s, MaterialPoint m, vec3 wo, vec3 wi, float specular_alpha) {
  if (!kReceiversHaveLobes || (!kSceneHasMetal && !kSceneHasGloss)) return evaluateBase(baseScale(m.optics), vec3(1.0), vec3(1.0));
  vec3 across = abs(s.shading.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
  vec3 tangent = normalize(cross(s.shading, across));
  vec3 bitangent = cross(s.shading, tangent);
  return evaluateReceiver(m.optics, vec3(dot(wo, tangent), dot(wo, bitangent), dot(wo, s.shading)),
                          vec3(dot(wi, tangent), dot(wi, bitangent), dot(wi, s.shading)), specular_alpha);
}

#endif
