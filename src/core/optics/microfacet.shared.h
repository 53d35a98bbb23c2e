// Isotropic GGX (Trowbridge–Reitz) microfacets with Smith masking, in the local frame whose z axis is the normal.
//
// Sources: distribution and masking [walter-2007] eqs. 33, 34; height-correlated masking [heitz-2014] eq. 99;
// visible-normal sampling by a spherical cap [dupuy-benyoub-2023] §4. `wo`, `wi` and `h` are unit. A facet is only
// seen from its front: where dot(w, h) and w.z differ in sign the caller has no facet, and these functions do not ask.
// The limit alpha = 0 is a mirror and belongs to delta lobes; here alpha > 0 unless said.
//
// With wo.z > 0 and h from sampleGgxVndf, the weight f·cos/pdf of a sample is F·ggxG2/ggxG1(wo) for reflection and
// (1 − F)·ggxG2Transmission/ggxG1(wo) for transmission.
#ifndef NEPHROID_MICROFACET_SHARED_H
#define NEPHROID_MICROFACET_SHARED_H

#include "bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

NEPHROID_CONST float kMicrofacetPi = 3.14159265358979f;

/// Density of facet normals: area of facets per solid angle of `h` and per area of the surface, 1/sr.
/// ∫ D(h) h.z dh = 1 over the hemisphere; 0 below it.
/// @note  The usual α²/(π(cos²(α² − 1) + 1)²) cancels for small α near the peak; 1 = sin² + cos² avoids it.
NEPHROID_FN float ggxD(vec3 h, float alpha) {
  if (h.z <= 0.0f) return 0.0f;
  float a2 = alpha * alpha;
  float s = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
  return a2 / (kMicrofacetPi * s * s);
}

/// sqrt(cos² + α² sin²) of w: the projected, stretched length from which all of Smith's terms are made.
NEPHROID_FN float ggxStretch(vec3 w, float alpha) { return sqrt(w.z * w.z + alpha * alpha * (w.x * w.x + w.y * w.y)); }

/// Smith's Λ: invisible over visible facet area in direction w, either side; infinite at grazing w.
NEPHROID_FN float ggxLambda(vec3 w, float alpha) {
  float s = alpha * alpha * (w.x * w.x + w.y * w.y);
  float cos_theta = abs(w.z);
  if (s == 0.0f) return 0.0f;
  return s / (2.0f * cos_theta * (cos_theta + ggxStretch(w, alpha)));
}

/// Fraction of the facets that are seen from w, 1/(1 + Λ(w)), in [0, 1]; 0 at grazing w.
NEPHROID_FN float ggxG1(vec3 w, float alpha) {
  float cos_theta = abs(w.z);
  float sum = cos_theta + ggxStretch(w, alpha);
  return sum > 0.0f ? 2.0f * cos_theta / sum : 0.0f;
}

/// Facets seen from both wi and wo on the same side, correlated by height: 1/(1 + Λ(wi) + Λ(wo)). Symmetric.
NEPHROID_FN float ggxG2(vec3 wi, vec3 wo, float alpha) {
  float cos_i = abs(wi.z);
  float cos_o = abs(wo.z);
  float sum = cos_o * ggxStretch(wi, alpha) + cos_i * ggxStretch(wo, alpha);
  return sum > 0.0f ? 2.0f * cos_i * cos_o / sum : 0.0f;
}

/// Facets seen from wi and wo on opposite sides: G1(wi)·G1(wo), symmetric.
///
/// What is high for one side is low for the other, so the correlated form of reflection is too bright here. The form
/// correlated by height is the Beta function B(1 + Λ(wi), 1 + Λ(wo)) [heitz-2016]. We take the separable one of
/// [walter-2007] eq. 23 because most renderers that one compares with do. It is brighter: at α = 0.25 by 0.1 % with
/// both directions at 60°, by 7 % at 80° and by a third at 84°.
NEPHROID_FN float ggxG2Transmission(vec3 wi, vec3 wo, float alpha) { return ggxG1(wi, alpha) * ggxG1(wo, alpha); }

/// A facet normal with the density of facets seen from wo.
///
/// @param wo     wo.z >= 0
/// @param alpha  >= 0; at 0 the result is (0, 0, 1)
/// @param u      in [0, 1)²
/// @return       unit h, h.z > 0, dot(wo, h) >= 0 up to rounding
NEPHROID_FN vec3 sampleGgxVndf(vec3 wo, float alpha, vec2 u) {
  // Stretched to alpha 1 the facets are a hemisphere, and its mirror directions of wo fill a spherical cap evenly.
  vec3 w = normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
  // Vulkan promises sine and cosine within [−π, π] only. The difference is exact.
  float phi = 2.0f * kMicrofacetPi * (u.x < 0.5f ? u.x : u.x - 1.0f);
  float one_minus_z = u.y * (1.0f + w.z);
  float sin_theta = sqrt(max(one_minus_z * (2.0f - one_minus_z), 0.0f));
  vec3 mirrored = vec3(sin_theta * cos(phi), sin_theta * sin(phi), 1.0f - one_minus_z);
  vec3 h = mirrored + w;
  // Rounding can leave a facet that is edge-on to wo below the horizon.
  return normalize(vec3(alpha * h.x, alpha * h.y, max(h.z, 1e-7f)));
}

/// Density of sampleGgxVndf per solid angle of h, 1/sr: G1(wo)·max(0, wo·h)·D(h)/cos(wo), finite at grazing wo.
/// For the reflected direction divide by 4·dot(wo, h); for the refracted one multiply by the Jacobian of
/// [walter-2007] eq. 17.
NEPHROID_FN float pdfGgxVndf(vec3 wo, vec3 h, float alpha) {
  float sum = abs(wo.z) + ggxStretch(wo, alpha);
  if (sum <= 0.0f) return 0.0f;
  return 2.0f * max(dot(wo, h), 0.0f) * ggxD(h, alpha) / sum;
}

/// The u for which sampleGgxVndf(wo, alpha, u) is h; alpha > 0, h.z > 0, dot(wo, h) > 0.
NEPHROID_FN vec2 invertGgxVndf(vec3 wo, vec3 h, float alpha) {
  vec3 w = normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
  vec3 m = normalize(vec3(h.x, h.y, alpha * h.z));
  float scale = 2.0f * dot(w, m);
  float x = scale * m.x - w.x;
  float y = scale * m.y - w.y;
  float z = scale * m.z - w.z;
  // Of 1 − z the form without cancellation is taken near z = 1.
  float one_minus_z = z > 0.0f ? (x * x + y * y) / (1.0f + z) : 1.0f - z;
  float turn = atan(y, x) / (2.0f * kMicrofacetPi);
  return vec2(turn - floor(turn), one_minus_z / (1.0f + w.z));
}

NEPHROID_NAMESPACE_END

#endif
