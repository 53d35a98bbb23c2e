// What a surface makes of light: one microfacet interface (mirror, metal, glass, varnish) over one diffuse base.
//
//   interface, reflected     R(θ) = metallic·F_metal(θ) + (1 − metallic)·gloss·tint·F(θ)
//   interface, transmitted   T(θ) = (1 − metallic)·transmission·base·(1 − tint·F(θ))
//   base                     f = (1 − metallic)(1 − transmission)·base/π · (1 − gF(θi))(1 − gF(θo)) / (1 − g<F>)
//
// with F the exact dielectric Fresnel reflectance (of both faces together for a pane's R and T), F_metal Schlick's with
// F0 = base (glTF) or the exact one of a complex index, g = gloss·tint and <F> the average of F over the hemisphere.
// The base's form is reciprocal and, for a white base under a smooth interface, loses and gains nothing (after
// [kelemen-2001]); glTF's own (1 − F(v·h)) would return up to 1.9 times what arrives at grazing angles. A rough
// interface spreads R over GGX microfacets ([walter-2007] eqs. 20, 33) with masking correlated by height
// ([heitz-2014] eq. 99); light that meets more than one facet is lost.
//
// `wo` and `wi` are unit and local to the shaded surface: z is its normal on wo's side. Whether both directions lie on
// the same side of the true, geometric surface is for the caller to ask.
//
// The functions are small and take what is already known (a Fresnel reflectance, the base's factor at wo), because a
// path evaluates several of them at one vertex.
#ifndef NEPHROID_SURFACE_SHARED_H
#define NEPHROID_SURFACE_SHARED_H

#include "fresnel.shared.h"
#include "microfacet.shared.h"

NEPHROID_NAMESPACE_BEGIN

/// A lobe counts as specular (an S event) if its microfacet alpha is below this.
NEPHROID_CONST float kDefaultSpecularAlpha = 0.25f;
/// Below this microfacet width a lobe is a mirror in single precision: its half-width is under 0.02 degrees.
NEPHROID_CONST float kDeltaAlpha = 5e-4f;

/// Weight of the dielectric specular lobe over a base that does not transmit: 1 up to the alpha at which a lobe stops
/// being specular, then falling linearly to 0 at alpha 1. So a fully rough dielectric is exactly Lambertian and its
/// base colour is its whole albedo, which is what authors mean by roughness 1 and what measured albedos state;
/// single-scattering GGX at alpha 1 would add about 1.4 % of a Lambertian lobe and take 4 to 9 % from the base.
/// What transmits has a real interface at any roughness, of weight 1.
///
/// @param alpha         microfacet width, in [0, 1]
/// @param transmission  in [0, 1]
/// @return              in [0, 1]
NEPHROID_FN float glossOf(float alpha, float transmission) {
  float faded = clamp((1.0f - alpha) / (1.0f - kDefaultSpecularAlpha), 0.0f, 1.0f);
  return transmission + (1.0f - transmission) * faded;
}

/// The optics of a surface at one point, textures resolved; 88 bytes in scalar block layout. Flags are 0 or 1.
struct SurfaceOptics {
  vec3 base;              // base colour, linear Rec. 709, in [0, 1]
  float metallic;         // in [0, 1]
  float alpha;            // microfacet width of the interface; exactly 0: smooth
  float transmission;     // share of what is not metal that transmits instead of scattering diffusely, in [0, 1]
  float gloss;            // weight of the dielectric specular lobe, in [0, 1]; 1 where transmission is 1
  vec3 specular_tint;     // KHR_materials_specular, factor and colour, in [0, 1]
  float ior_from;         // index of the medium on wo's side, > 0
  float ior_to;           // index behind the surface; for what is not solid that of its own substance, > 0
  float average_fresnel;  // 2∫F(c)·c dc towards ior_to/ior_from; used where base and gloss are above 0
  vec3 conductor_ior;     // complex index of the metal, n + ik per channel; used where has_conductor
  vec3 conductor_k;
  uint has_conductor;  // the complex index replaces Schlick's F0 = base
  uint is_pane;        // transmits, thin-walled
  uint is_solid;       // bounds a medium of another index
};

/// Reflectance F of one dielectric face, which all that follows is made from; 0 where none of it asks.
///
/// @param cos_theta  of incidence, towards the side of ior_from; clamped to [0, 1]
/// @return           in [0, 1]
NEPHROID_FN float interfaceFresnel(SurfaceOptics s, float cos_theta) {
  // A GPU's quotient of equal indices need not be 1, and next to 1 a critical angle may be short of grazing incidence.
  bool wanted = s.metallic < 1.0f && s.gloss > 0.0f && s.ior_from != s.ior_to;
  return wanted ? fresnelDielectric(cos_theta, s.ior_from / s.ior_to) : 0.0f;
}

/// Share of light that the interface reflects, R of the top of this file.
///
/// @param cos_theta  of incidence at the interface or, if it is rough, at the microfacet; clamped to [0, 1]
/// @param fresnel    interfaceFresnel at the same cosine
/// @return           per channel, in [0, 1]
NEPHROID_FN vec3 interfaceReflectance(SurfaceOptics s, float cos_theta, float fresnel) {
  vec3 reflectance = vec3(0.0f);
  if (s.metallic > 0.0f) {
    vec3 metal = s.has_conductor != 0u ? fresnelConductor(cos_theta, s.conductor_ior, s.conductor_k)
                                       : fresnelSchlick(cos_theta, s.base);
    reflectance = metal * s.metallic;
  }
  if (s.metallic < 1.0f && s.gloss > 0.0f) {
    float r = s.is_pane != 0u ? fresnelThinPane(fresnel) : fresnel;
    reflectance += s.specular_tint * ((1.0f - s.metallic) * s.gloss * r);
  }
  return reflectance;
}

/// Share of light that the interface lets through to the other side, T of the top of this file.
///
/// @param fresnel  interfaceFresnel at the cosine of incidence
/// @return         per channel, in [0, 1]; R + T <= 1
NEPHROID_FN vec3 interfaceTransmittance(SurfaceOptics s, float fresnel) {
  if (s.transmission == 0.0f || s.metallic == 1.0f) return vec3(0.0f);
  // Beyond the critical angle there is no direction to transmit into, whatever the tint. A pane's own reflectance is a
  // quotient, which on a GPU may then be a little less than 1.
  if (fresnel >= 1.0f) return vec3(0.0f);
  float r = s.is_pane != 0u ? fresnelThinPane(fresnel) : fresnel;
  return s.base * ((1.0f - s.metallic) * s.transmission) * (vec3(1.0f) - s.specular_tint * r);
}

/// Share of the surface that is neither metal nor transmits, in [0, 1]: there is no base where it is 0.
NEPHROID_FN float baseWeight(SurfaceOptics s) { return (1.0f - s.metallic) * (1.0f - s.transmission); }

/// What the base's value has in common for all directions: (1 − metallic)(1 − transmission)·base / (1 − g<F>).
///
/// @return  per channel, >= 0; above 1 for bright bases, whose light the interface sends back to them
NEPHROID_FN vec3 baseScale(SurfaceOptics s) {
  vec3 scale = s.base * baseWeight(s);
  if (s.gloss > 0.0f) scale = scale / (vec3(1.0f) - s.specular_tint * (s.gloss * s.average_fresnel));
  return scale;
}

/// Share of light that the interface lets through to or from the base in one direction: 1 − gF(θ).
///
/// @param fresnel  interfaceFresnel at the cosine of that direction
/// @return         per channel, in [0, 1]
NEPHROID_FN vec3 baseFactor(SurfaceOptics s, float fresnel) {
  if (s.gloss == 0.0f) return vec3(1.0f);
  return vec3(1.0f) - s.specular_tint * (s.gloss * fresnel);
}

/// The base's BRDF, 1/sr, without the cosine.
///
/// @param scale     baseScale
/// @param factor_o  baseFactor towards wo
/// @param factor_i  baseFactor towards wi
NEPHROID_FN vec3 evaluateBase(vec3 scale, vec3 factor_o, vec3 factor_i) {
  return scale * factor_i * factor_o * (1.0f / kMicrofacetPi);
}

/// GGX microfacets seen as a reflector, for facets that reflect everything: D·G2/(4·cos·cos), 1/sr.
///
/// @param wo     wo.z >= 0
/// @param wi     wi.z > 0
/// @param h      unit half vector, h.z > 0
/// @param alpha  > 0
/// @note  In the plain form, ggxD(h)·ggxG2(wi, wo)/(4·wo.z·wi.z), the cosines of G2 and of the denominator cancel, and
///        at grazing directions a GPU would divide zero by a product that it flushed to zero.
NEPHROID_FN float evaluateFacets(vec3 wo, vec3 wi, vec3 h, float alpha) {
  float sum = wo.z * ggxStretch(wi, alpha) + wi.z * ggxStretch(wo, alpha);
  return ggxD(h, alpha) / (2.0f * sum);
}

/// The reflecting lobe of a rough interface, 1/sr, without the cosine ([walter-2007] eq. 20).
///
/// @return  per channel; 0 where the interface is smooth (its lobe is a delta) or a direction is not above the surface
NEPHROID_FN vec3 evaluateInterface(SurfaceOptics s, vec3 wo, vec3 wi) {
  if (s.alpha == 0.0f || wo.z <= 0.0f || wi.z <= 0.0f) return vec3(0.0f);
  // Half the length of the sum is the cosine to the half vector, of both directions to the last bit: near the critical
  // angle, where F has an infinite slope, two scalar products would differ in the sixth digit of the lobe.
  vec3 sum = wo + wi;
  float sum_length = length(sum);
  if (sum_length == 0.0f) return vec3(0.0f);
  vec3 h = sum / sum_length;
  float cos_theta_h = 0.5f * sum_length;
  return interfaceReflectance(s, cos_theta_h, interfaceFresnel(s, cos_theta_h)) * evaluateFacets(wo, wi, h, s.alpha);
}

/// All class-D lobes that reflect, 1/sr, without the cosine: what a receiver makes of direct light and of photons.
///
/// The base always counts; the interface only if it is rough and not class S.
///
/// @param specular_alpha  an interface of smaller alpha is class S
/// @return                per channel, the same for wo and wi exchanged; 0 where one of them is not above the surface
NEPHROID_FN vec3 evaluateReceiver(SurfaceOptics s, vec3 wo, vec3 wi, float specular_alpha) {
  if (wo.z <= 0.0f || wi.z <= 0.0f) return vec3(0.0f);
  vec3 value = vec3(0.0f);
  if (baseWeight(s) > 0.0f)
    value =
        evaluateBase(baseScale(s), baseFactor(s, interfaceFresnel(s, wo.z)), baseFactor(s, interfaceFresnel(s, wi.z)));
  if (s.alpha >= specular_alpha) value += evaluateInterface(s, wo, wi);
  return value;
}

NEPHROID_NAMESPACE_END

#ifdef __cplusplus
#include <cstddef>
#include <type_traits>

static_assert(std::is_standard_layout_v<nephroid::SurfaceOptics>);
static_assert(std::is_trivially_copyable_v<nephroid::SurfaceOptics>);
static_assert(sizeof(nephroid::SurfaceOptics) == 88);
static_assert(offsetof(nephroid::SurfaceOptics, base) == 0);
static_assert(offsetof(nephroid::SurfaceOptics, metallic) == 12);
static_assert(offsetof(nephroid::SurfaceOptics, alpha) == 16);
static_assert(offsetof(nephroid::SurfaceOptics, transmission) == 20);
static_assert(offsetof(nephroid::SurfaceOptics, gloss) == 24);
static_assert(offsetof(nephroid::SurfaceOptics, specular_tint) == 28);
static_assert(offsetof(nephroid::SurfaceOptics, ior_from) == 40);
static_assert(offsetof(nephroid::SurfaceOptics, ior_to) == 44);
static_assert(offsetof(nephroid::SurfaceOptics, average_fresnel) == 48);
static_assert(offsetof(nephroid::SurfaceOptics, conductor_ior) == 52);
static_assert(offsetof(nephroid::SurfaceOptics, conductor_k) == 64);
static_assert(offsetof(nephroid::SurfaceOptics, has_conductor) == 76);
static_assert(offsetof(nephroid::SurfaceOptics, is_pane) == 80);
static_assert(offsetof(nephroid::SurfaceOptics, is_solid) == 84);
#endif

#endif
