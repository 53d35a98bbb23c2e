// The lobe of class S of a surface: what its interface reflects and lets through, smooth or by a microfacet, as Bsdf of
// trace/bsdf.cpp has it for radiance.
#ifndef NEPHROID_SPECULAR_LOBE_GLSL
#define NEPHROID_SPECULAR_LOBE_GLSL

#include "core/optics/refraction.shared.h"
#include "core/optics/surface.shared.h"

layout(constant_id = 8) const bool kSceneHasRoughSpecular = true;

/// Indices closer than this do not bend light measurably, and their half vector has no direction.
const float kMatchedIndex = 1e-5;

/// Directions about a normal.
struct Axes {
  vec3 x;
  vec3 y;
  vec3 z;
};

Axes axesAbout(vec3 normal) {
  vec3 across = abs(normal.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
  vec3 x = normalize(cross(normal, across));
  return Axes(x, cross(normal, x), normal);
}

vec3 toLocal(Axes axes, vec3 v) { return vec3(dot(v, axes.x), dot(v, axes.y), dot(v, axes.z)); }
vec3 toWorld(Axes axes, vec3 v) { return v.x * axes.x + v.y * axes.y + v.z * axes.z; }

bool isMatched(SurfaceOptics s) { return s.is_solid != 0u && abs(s.ior_from - s.ior_to) < kMatchedIndex * s.ior_from; }

/// Radiance over the squared index is what refraction keeps.
float radianceScale(SurfaceOptics s) {
  float ratio = s.ior_from / s.ior_to;
  return s.is_solid != 0u ? ratio * ratio : 1.0;
}

/// Both ways on from a surface.
struct Scattered {
  vec3 reflected_weight;  // radiance that arrives is times this; 0: no such way
  vec3 reflected;         // unit
  vec3 transmitted_weight;
  vec3 transmitted;
};

Scattered scatterSmooth(SurfaceOptics s, vec3 dir, vec3 normal) {
  float cos_o = max(-dot(dir, normal), 0.0);
  float fresnel = interfaceFresnel(s, cos_o);
  Scattered result = Scattered(interfaceReflectance(s, cos_o, fresnel), reflectDir(dir, normal),
                               interfaceTransmittance(s, fresnel), dir);
  if (s.is_pane != 0u || isMatched(s)) return result;
  Refraction refraction = refractDir(dir, normal, s.ior_from / s.ior_to);
  result.transmitted = refraction.dir;
  result.transmitted_weight *= refraction.valid ? radianceScale(s) : 0.0;
  return result;
}

/// By one facet, drawn from those that are seen.
Scattered scatterRough(SurfaceOptics s, vec3 dir, vec3 normal, vec2 u) {
  Axes axes = axesAbout(normal);
  vec3 wo = toLocal(axes, -dir);
  Scattered result = Scattered(vec3(0.0), normal, vec3(0.0), dir);
  if (wo.z <= 0.0) return result;
  vec3 h = sampleGgxVndf(wo, s.alpha, u);
  float wo_h = dot(wo, h);
  if (wo_h <= 0.0) return result;
  float fresnel = interfaceFresnel(s, wo_h);
  float inverse_seen = 1.0 / ggxG1(wo, s.alpha);
  vec3 wi = reflectDir(-wo, h);
  result.reflected = toWorld(axes, wi);
  float reflected_share = wi.z > 0.0 ? ggxG2(wi, wo, s.alpha) * inverse_seen : 0.0;
  result.reflected_weight = interfaceReflectance(s, wo_h, fresnel) * reflected_share;
  vec3 through = interfaceTransmittance(s, fresnel);
  if (isMatched(s)) {
    result.transmitted_weight = through;
  } else if (s.is_pane != 0u) {
    // It spreads what it transmits as it spreads what it reflects, to the other side.
    result.transmitted = toWorld(axes, vec3(wi.xy, -wi.z));
    result.transmitted_weight = through * reflected_share;
  } else {
    Refraction refraction = refractDir(-wo, h, s.ior_from / s.ior_to);
    if (!refraction.valid || refraction.dir.z >= 0.0) return result;
    result.transmitted = toWorld(axes, refraction.dir);
    result.transmitted_weight =
        through * (ggxG2Transmission(refraction.dir, wo, s.alpha) * inverse_seen * radianceScale(s));
  }
  return result;
}

/// The lobe of a rough interface along two directions, 1/sr, without the cosine: Bsdf::evaluateInterface.
/// @param wo, wi  unit, about the normal on the side of wo; wi on either side
vec3 evaluateRough(SurfaceOptics s, vec3 wo, vec3 wi) {
  if (wi.z > 0.0) return evaluateInterface(s, wo, wi);
  bool is_pane = s.is_pane != 0u;
  if (wo.z <= 0.0 || wi.z == 0.0 || isMatched(s) || (!is_pane && s.is_solid == 0u)) return vec3(0.0);
  if (is_pane) wi.z = -wi.z;
  vec3 h = is_pane ? wo + wi : s.ior_from * wo + s.ior_to * wi;
  if (dot(h, h) == 0.0) return vec3(0.0);
  h = normalize(h);
  if (h.z < 0.0) h = -h;
  float wo_h = dot(wo, h), wi_h = dot(wi, h);
  if (wo_h <= 0.0) return vec3(0.0);
  vec3 through = interfaceTransmittance(s, interfaceFresnel(s, wo_h));
  if (is_pane) return wi_h > 0.0 ? through * evaluateFacets(wo, wi, h, s.alpha) : vec3(0.0);
  if (wi_h >= 0.0) return vec3(0.0);
  float denominator = s.ior_from * wo_h + s.ior_to * wi_h;
  float jacobian = s.ior_to * s.ior_to * abs(wi_h) / (denominator * denominator);
  return through * (ggxD(h, s.alpha) * ggxG2Transmission(wi, wo, s.alpha) * wo_h * jacobian / (wo.z * abs(wi.z)) *
                    radianceScale(s));
}

#endif
