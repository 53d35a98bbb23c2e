// How much of the light that meets a smooth interface is reflected: dielectrics, conductors, thin panes.
//
// All values are for unpolarised light (the mean of both polarisations). Sources: Born and Wolf, Principles of
// Optics, §1.5 (dielectrics) and §14.2 (absorbing media); the approximation is [schlick-1994] eq. 15.
#ifndef NEPHROID_FRESNEL_SHARED_H
#define NEPHROID_FRESNEL_SHARED_H

#include "bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

/// Reflectance of an interface between two dielectrics, exact.
///
/// @param cos_theta_i  cosine between the normal and the direction to where light comes from; clamped to [0, 1]
/// @param ior_ratio    ior_from / ior_to, > 0
/// @return             in [0, 1]; 1 beyond the critical angle; exactly 0 where ior_ratio is exactly 1
/// @note  The plain form, with c = cos_theta_i, t = sqrt(1 − r²(1 − c²)) and r = ior_ratio, is
///        (((r·c − t)/(r·c + t))² + ((r·t − c)/(r·t + c))²)/2. Both numerators cancel where r is near 1 (a gel in
///        glass, a band of a dispersive prism), so each is multiplied by its conjugate: r·c − t becomes
///        (r² − 1)/(r·c + t), and r·t − c becomes (1 − r²)(r² − c²(1 + r²))/(r·t + c), whose first factor is computed
///        without cancellation. The second factor is 0 at Brewster's angle.
NEPHROID_FN float fresnelDielectric(float cos_theta_i, float ior_ratio) {
  if (ior_ratio == 1.0f) return 0.0f;
  float c = clamp(cos_theta_i, 0.0f, 1.0f);
  float r2 = ior_ratio * ior_ratio;
  float one_minus_r2 = (1.0f - ior_ratio) * (1.0f + ior_ratio);
  float t2 = one_minus_r2 + r2 * c * c;
  if (t2 <= 0.0f) return 1.0f;
  float t = sqrt(t2);
  float sum_s = ior_ratio * c + t;
  float sum_p = ior_ratio * t + c;
  float amplitude_s = one_minus_r2 / (sum_s * sum_s);
  float amplitude_p = one_minus_r2 * (r2 - c * c * (1.0f + r2)) / (sum_p * sum_p);
  return min(0.5f * (amplitude_s * amplitude_s + amplitude_p * amplitude_p), 1.0f);
}

/// Schlick's approximation, per channel: f0 at normal incidence, 1 at grazing incidence.
///
/// @param cos_theta_i  clamped to [0, 1]
/// @param f0           reflectance at normal incidence, in [0, 1]
NEPHROID_FN vec3 fresnelSchlick(float cos_theta_i, vec3 f0) {
  float m = 1.0f - clamp(cos_theta_i, 0.0f, 1.0f);
  float m2 = m * m;
  return f0 + (vec3(1.0f) - f0) * (m2 * m2 * m);
}

/// Reflectance of a conductor for one channel; see fresnelConductor.
///
/// a + ib is the transmitted ray's sqrt((n + ik)² − sin²θ). Whichever of a, b would come from a difference is had from
/// the product a·b = n·k instead. The real part n² − k² − sin²θ is summed as (n² − 1) − k² + c², for n near 1.
NEPHROID_FN float fresnelConductorChannel(float cos_theta_i, float ior, float k) {
  float c = clamp(cos_theta_i, 0.0f, 1.0f);
  if (c <= 0.0f) return 1.0f;
  float sin2 = (1.0f - c) * (1.0f + c);
  float re = (ior - 1.0f) * (ior + 1.0f) - k * k + c * c;
  float im = 2.0f * ior * k;
  float modulus = sqrt(re * re + im * im);
  float larger = sqrt(0.5f * (modulus + abs(re)));
  float smaller = larger > 0.0f ? 0.5f * im / larger : 0.0f;
  float a = re >= 0.0f ? larger : smaller;
  float b = re >= 0.0f ? smaller : larger;
  float b2 = b * b;
  float reflectance_s = ((a - c) * (a - c) + b2) / ((a + c) * (a + c) + b2);
  float minus = a * c - sin2;
  float plus = a * c + sin2;
  float ratio_p_over_s = (minus * minus + b2 * c * c) / (plus * plus + b2 * c * c);
  return clamp(0.5f * reflectance_s * (1.0f + ratio_p_over_s), 0.0f, 1.0f);
}

/// Reflectance of a metal seen from vacuum, exact, per channel.
///
/// @param cos_theta_i  clamped to [0, 1]
/// @param ior          real part of the index, > 0
/// @param k            extinction coefficient (imaginary part), >= 0; with 0 this is fresnelDielectric
/// @return             in [0, 1]; 1 at grazing incidence
NEPHROID_FN vec3 fresnelConductor(float cos_theta_i, vec3 ior, vec3 k) {
  return vec3(fresnelConductorChannel(cos_theta_i, ior.x, k.x), fresnelConductorChannel(cos_theta_i, ior.y, k.y),
              fresnelConductorChannel(cos_theta_i, ior.z, k.z));
}

/// Reflectance of a clear pane from that of one of its faces: all inter-reflections between the two faces added up,
/// r + (1 − r)² r (1 + r² + r⁴ + …) = 2r/(1 + r). Phases are ignored: the pane is thicker than the coherence length.
///
/// @param r  reflectance of one face, in [0, 1]
NEPHROID_FN float fresnelThinPane(float r) { return 2.0f * r / (1.0f + r); }

NEPHROID_NAMESPACE_END

#endif
