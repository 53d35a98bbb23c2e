// Compiled, not run: every shared header must be valid GLSL 4.60 as well as C++.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

#include "absorption.shared.h"
#include "dispersion.shared.h"
#include "fresnel.shared.h"
#include "lights.shared.h"
#include "microfacet.shared.h"
#include "photon.shared.h"
#include "ray_differential.shared.h"
#include "refraction.shared.h"
#include "surface.shared.h"
#include "../image/tonemap.shared.h"

layout(local_size_x = 64) in;

layout(scalar, set = 0, binding = 0) buffer Photons { Photon photons[]; };
layout(scalar, set = 0, binding = 1) readonly buffer Batches { PhotonBatch batches[]; };
layout(scalar, set = 0, binding = 2) writeonly buffer Results { vec3 results[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Surfaces { SurfaceOptics surfaces[]; };

vec3 scatter(Photon p, vec3 n) {
  float cos_theta_i = -dot(p.direction, n);
  vec3 reflectance = vec3(fresnelDielectric(cos_theta_i, 1.0 / dispersiveIor(1.5, 0.3, 500.0))) +
                     fresnelSchlick(cos_theta_i, vec3(0.04)) + fresnelConductor(cos_theta_i, vec3(0.2), vec3(3.0));
  Refraction refracted = refractDir(p.direction, n, 1.0 / 1.5);
  vec3 h = sampleGgxVndf(-p.direction, 0.2, invertGgxVndf(-p.direction, n, 0.2));
  float masking = ggxG2(-p.direction, h, 0.2) * ggxG2Transmission(-p.direction, h, 0.2) * ggxLambda(h, 0.2);
  vec3 dir = refracted.valid ? refracted.dir : reflectDir(p.direction, n);
  return dir * (fresnelThinPane(reflectance.x) * masking * pdfGgxVndf(dir, h, 0.2)) +
         transmittance(vec3(1.0), p.path_length);
}

RayDifferential propagate(Photon p, vec3 n) {
  RayDifferential r = RayDifferential(vec3(1.0), vec3(0.5), vec3(0.1), vec3(0.2), true);
  r = transferDifferential(r, p.direction, p.path_length, n);
  NormalDifferential dn = triangleNormalDifferential(r, p.position, p.flux, n, n, n, n, vec3(1.0, 0.0, 0.0));
  r = reflectDifferential(r, p.direction, n, dn);
  return refractDifferential(r, p.direction, n, dn, 1.0 / 1.5);
}

vec3 receive(SurfaceOptics surface, Photon p, vec3 n) {
  float cos_theta_i = -dot(p.direction, n);
  vec3 intensity = spotIntensity(p.flux, n, 0.9, 0.8, p.direction) * spotFalloff(cos_theta_i, 0.9, 0.8);
  vec3 irradiance = irradianceFromPoint(intensity, p.path_length, cos_theta_i) + irradianceFromSun(p.flux, cos_theta_i);
  vec3 passed = interfaceTransmittance(surface, interfaceFresnel(surface, cos_theta_i));
  return evaluateReceiver(surface, n, -p.direction, 0.25) * irradiance * passed;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= batches[0].emitted_count || batches[0].band_count == 0u) return;
  Photon p = photons[i];
  vec3 n = vec3(0.0, 1.0, 0.0);
  RayDifferential r = propagate(p, n);
  p = setPhotonFootprint(p, r.dp_dx, r.dp_dy, n);
  Footprint footprint = photonFootprint(p, n);
  p.chain = hashChain(p.chain, photonLight(p));
  p.light_band_flags = packLightBandFlags(photonLight(p), photonBand(p), photonFlags(p) | kPhotonValid);
  if (hasPhotonFlag(p, kPhotonLeftScene)) p.flux = vec3(0.0);
  photons[i] = p;
  results[i] = scatter(p, n) + receive(surfaces[i], p, n) + footprint.axis_a + footprint.axis_b;
}
