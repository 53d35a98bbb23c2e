// Every function of fresnel.shared.h on one input, for the device and for C++. No include guard: its test compiles it
// twice.
#include "core/optics/fresnel.shared.h"

NEPHROID_NAMESPACE_BEGIN

struct FresnelInput {
  float cos_theta_i;
  float ior_ratio;
  vec3 f0;
  vec3 ior;
  vec3 k;
  float face;
};

struct FresnelOutput {
  float dielectric;
  vec3 schlick;
  vec3 conductor;
  float conductor_channel;
  float pane;
};

NEPHROID_FN FresnelOutput evaluateFresnel(FresnelInput given) {
  FresnelOutput result;
  result.dielectric = fresnelDielectric(given.cos_theta_i, given.ior_ratio);
  result.schlick = fresnelSchlick(given.cos_theta_i, given.f0);
  result.conductor = fresnelConductor(given.cos_theta_i, given.ior, given.k);
  result.conductor_channel = fresnelConductorChannel(given.cos_theta_i, given.ior.y, given.k.y);
  result.pane = fresnelThinPane(given.face);
  return result;
}

NEPHROID_NAMESPACE_END
