// Every function of surface.shared.h on one input, for the device and for C++. No include guard: its test compiles it
// twice.
#include "core/optics/surface.shared.h"

NEPHROID_NAMESPACE_BEGIN

// The fields of SurfaceOptics, its flags as floats, then what its functions take beside it.
struct SurfaceInput {
  vec3 base;
  float metallic;
  float alpha;
  float transmission;
  float gloss;
  vec3 specular_tint;
  float ior_from;
  float ior_to;
  float average_fresnel;
  vec3 conductor_ior;
  vec3 conductor_k;
  float has_conductor;
  float is_pane;
  float is_solid;
  float cos_theta;
  float fresnel;
  vec3 wo;
  vec3 wi;
  vec3 h;
  float specular_alpha;
};

struct SurfaceOutput {
  float gloss;
  float fresnel;
  vec3 reflectance;
  vec3 transmittance;
  float base_weight;
  vec3 base_scale;
  vec3 base_factor;
  vec3 base;
  float facets;
  vec3 interface_value;
  vec3 receiver;
};

NEPHROID_FN SurfaceOutput evaluateSurface(SurfaceInput given) {
  SurfaceOptics s;
  s.base = given.base;
  s.metallic = given.metallic;
  s.alpha = given.alpha;
  s.transmission = given.transmission;
  s.gloss = given.gloss;
  s.specular_tint = given.specular_tint;
  s.ior_from = given.ior_from;
  s.ior_to = given.ior_to;
  s.average_fresnel = given.average_fresnel;
  s.conductor_ior = given.conductor_ior;
  s.conductor_k = given.conductor_k;
  s.has_conductor = uint(given.has_conductor);
  s.is_pane = uint(given.is_pane);
  s.is_solid = uint(given.is_solid);

  SurfaceOutput result;
  result.gloss = glossOf(given.alpha, given.transmission);
  result.fresnel = interfaceFresnel(s, given.cos_theta);
  // With a given reflectance, so that each of these is judged by its own operations.
  result.reflectance = interfaceReflectance(s, given.cos_theta, given.fresnel);
  result.transmittance = interfaceTransmittance(s, given.fresnel);
  result.base_weight = baseWeight(s);
  result.base_scale = baseScale(s);
  result.base_factor = baseFactor(s, given.fresnel);
  result.base = evaluateBase(result.base_scale, result.base_factor, result.base_factor);
  // Of a smooth interface there are no facets, and none is seen from below.
  bool seen = given.alpha > 0.0f && given.wo.z >= 0.0f && given.wi.z > 0.0f && given.h.z > 0.0f;
  result.facets = seen ? evaluateFacets(given.wo, given.wi, given.h, given.alpha) : 0.0f;
  result.interface_value = evaluateInterface(s, given.wo, given.wi);
  result.receiver = evaluateReceiver(s, given.wo, given.wi, given.specular_alpha);
  return result;
}

NEPHROID_NAMESPACE_END
