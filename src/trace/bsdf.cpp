#include "trace/bsdf.h"

#include <algorithm>
#include <cmath>

#include "core/optics/refraction.shared.h"
#include "core/sampling/warp.h"

namespace nephroid {
namespace {

/// Indices closer than this do not bend light measurably, and their half vector has no direction.
constexpr float kMatchedIndex = 1e-5F;

}  // namespace

Bsdf::Bsdf(const SurfaceMaterial& material, const SurfacePoint& point, vec3 wo, float ior_from, float ior_to,
           float specular_alpha)
    : material_(material), wo_(wo), normal_geometric_(point.normal_geometric), ior_from_(ior_from) {
  side_is_outward_ = dot(wo, point.normal_geometric) > 0.0F;
  const vec3 normal = side_is_outward_ ? point.normal_shading : -point.normal_shading;
  const bool usable = dot(normal, wo) > kLeastShadingCosine;
  normal_ = usable ? normal : (side_is_outward_ ? point.normal_geometric : -point.normal_geometric);
  ior_to_ = material.is_solid ? ior_to : material.source->ior;
  smooth_ = material.alpha == 0.0F;
  if (!smooth_) {
    frame_ = Frame::fromZ(normal_);
    wo_local_ = frame_.toLocal(wo);
  }
  interface_is_specular_ = material.alpha < specular_alpha;
  index_matched_ = material.is_solid && std::abs(ior_from_ - ior_to_) < kMatchedIndex * ior_from_;

  const float cos_o = std::max(dot(wo, normal_), 0.0F);
  const float fresnel_o = fresnelAt(cos_o);
  reflectance_ = reflectanceAt(cos_o, fresnel_o);
  transmittance_ = transmittanceFor(fresnel_o);
  base_scale_ = vec3(0.0F);
  base_albedo_ = vec3(0.0F);
  base_factor_o_ = vec3(0.0F);
  const float base_weight = baseWeight(surface());
  if (base_weight > 0.0F) {
    if (material.gloss > 0.0F) average_fresnel_ = averageFresnel(ior_to_ / ior_from_);
    base_scale_ = baseScale(surface());
    base_factor_o_ = baseFactorFor(fresnel_o);
    base_albedo_ = base_weight * material.base * base_factor_o_;
  }
  const float interface_weight = luminance(reflectance_ + transmittance_);
  const float base_luminance = luminance(base_albedo_);
  const float sum = interface_weight + base_luminance;
  interface_probability_ = sum > 0.0F ? interface_weight / sum : 0.0F;
}

vec3 Bsdf::reflectanceAt(float cos_theta, float fresnel) const {
  return interfaceReflectance(surface(), cos_theta, fresnel);
}

float Bsdf::radianceScale(Transport transport) const {
  if (transport == Transport::kFlux || !material_.is_solid) return 1.0F;
  const float ratio = ior_from_ / ior_to_;
  return ratio * ratio;
}

float Bsdf::shadingCosineRatio(vec3 w) const {
  const float geometric = std::abs(dot(w, normal_geometric_));
  return geometric > 0.0F ? std::abs(dot(w, normal_)) / geometric : 0.0F;
}

bool Bsdf::hasConstantDiffuse() const {
  const bool by_interface = !interface_is_specular_ && !smooth_ && interface_probability_ > 0.0F;
  return !by_interface && !(material_.gloss > 0.0F);
}

std::optional<vec3> Bsdf::constantDiffuse() const {
  if (!hasConstantDiffuse()) return std::nullopt;
  return evaluateBase(base_scale_, base_factor_o_, baseFactorFor(0.0F));
}

BsdfValue Bsdf::evaluate(EventClass c, vec3 wi, Transport transport) const {
  BsdfValue value;
  const float cos_i = dot(wi, normal_);
  const bool reflected = sameSide(wi);
  // Light must be on the same side of the true and the shaded surface, else it leaks through.
  if (reflected != (cos_i > 0.0F) || cos_i == 0.0F) return value;
  const bool interface_counts = (c == EventClass::kSpecular) == interface_is_specular_ && !smooth_;
  const float p_interface = c == EventClass::kSpecular ? 1.0F : interface_is_specular_ ? 0.0F : interface_probability_;
  if (interface_counts && interface_probability_ > 0.0F) {
    value = evaluateInterface(frame_.toLocal(wi), reflected, transport);
    value.pdf *= p_interface;
  }
  if (c == EventClass::kDiffuse && reflected) {
    value.f += evaluateBase(base_scale_, base_factor_o_, baseFactorFor(fresnelAt(cos_i)));
    value.pdf += (1.0F - p_interface) * cos_i * (1.0F / kPi);
  }
  return value;
}

BsdfValue Bsdf::evaluateInterface(vec3 wi, bool reflected, Transport transport) const {
  BsdfValue value;
  const float alpha = material_.alpha;
  const bool pane_transmission = !reflected && material_.is_pane;
  if (!reflected && (index_matched_ || (!material_.is_pane && !material_.is_solid))) return value;
  // A rough pane spreads what it transmits as it spreads what it reflects, to the other side.
  if (pane_transmission) wi.z = -wi.z;
  vec3 h = reflected || pane_transmission ? wo_local_ + wi : ior_from_ * wo_local_ + ior_to_ * wi;
  if (dot(h, h) == 0.0F) return value;
  h = normalize(h);
  if (h.z < 0.0F) h = -h;
  const float wo_h = dot(wo_local_, h), wi_h = dot(wi, h);
  if (wo_h <= 0.0F) return value;
  const float fresnel = fresnelAt(wo_h);
  const vec3 r = reflectanceAt(wo_h, fresnel), t = transmittanceFor(fresnel);
  const float sum = luminance(r) + luminance(t);
  if (sum <= 0.0F) return value;
  const float p_reflect = luminance(r) / sum;
  const float d = ggxD(h, alpha);
  const float pdf_h = pdfGgxVndf(wo_local_, h, alpha);
  if (reflected || pane_transmission) {
    if (wi_h <= 0.0F) return value;
    value.f = (reflected ? r : t) * evaluateFacets(wo_local_, wi, h, alpha);
    value.pdf = (reflected ? p_reflect : 1.0F - p_reflect) * pdf_h / (4.0F * wo_h);
    return value;
  }
  if (wi_h >= 0.0F) return value;
  const float denominator = ior_from_ * wo_h + ior_to_ * wi_h;
  const float jacobian = ior_to_ * ior_to_ * std::abs(wi_h) / (denominator * denominator);
  // Walter et al. 2007, eq. 21, as flux (scaled by the squared index of the side it goes to); `radianceScale` turns it
  // into the BSDF for radiance that arrives along wi.
  value.f = t * (d * ggxG2Transmission(wi, wo_local_, alpha) * wo_h * jacobian / (wo_local_.z * std::abs(wi.z)) *
                 radianceScale(transport));
  value.pdf = (1.0F - p_reflect) * pdf_h * jacobian;
  return value;
}

std::optional<BsdfSample> Bsdf::sample(EventClass c, vec2 u, float u_lobe, Transport transport) const {
  if (c == EventClass::kSpecular)
    return smooth_ ? sampleSmooth(u_lobe, transport) : sampleInterface(u, u_lobe, transport);
  if (interface_is_specular_) return sampleBase(u);
  const bool pick_interface = u_lobe < interface_probability_;
  std::optional<BsdfSample> s;
  if (pick_interface) {
    s = sampleInterface(u, std::min(u_lobe / interface_probability_, kOneMinusEpsilon), transport);
    if (s && s->delta) {
      s->weight /= interface_probability_;
      return s;
    }
  } else {
    s = sampleBase(u);
  }
  if (!s) return s;
  // One sample of the sum of both lobes.
  const BsdfValue both = evaluate(c, s->dir, transport);
  if (both.pdf <= 0.0F) return std::nullopt;
  s->pdf = both.pdf;
  s->weight = both.f * (std::abs(dot(s->dir, normal_)) / both.pdf);
  return s;
}

std::optional<BsdfSample> Bsdf::sampleBase(vec2 u) const {
  const vec3 local = sampleCosineHemisphere(u);
  BsdfSample s;
  s.dir = Frame::fromZ(normal_).toWorld(local);
  if (local.z <= 0.0F || !sameSide(s.dir)) return std::nullopt;
  s.pdf = local.z * (1.0F / kPi);
  s.weight = kPi * evaluateBase(base_scale_, base_factor_o_, baseFactorFor(fresnelAt(local.z)));
  return s;
}

Bsdf::Mirroring Bsdf::mirroring() const {
  const float r = luminance(reflectance_), sum = r + luminance(transmittance_);
  return {reflectance_, sum > 0.0F ? r / sum : 0.0F};
}

std::optional<BsdfSample> Bsdf::sampleSmooth(float u_lobe, Transport transport) const {
  if (luminance(reflectance_) + luminance(transmittance_) <= 0.0F) return std::nullopt;
  const float p_reflect = mirroring().probability;
  BsdfSample s;
  s.delta = true;
  if (u_lobe < p_reflect) {
    s.dir = reflectDir(-wo_, normal_);
    s.weight = reflectance_ / p_reflect;
    s.probability = p_reflect;
    if (!sameSide(s.dir)) return std::nullopt;
    return s;
  }
  s.transmitted = true;
  s.weight = transmittance_ / (1.0F - p_reflect);
  s.probability = 1.0F - p_reflect;
  if (material_.is_pane || index_matched_) {
    s.dir = -wo_;
    s.pass = material_.is_pane;
    return s;
  }
  const Refraction refraction = refractDir(-wo_, normal_, ior_from_ / ior_to_);
  if (!refraction.valid) return std::nullopt;
  s.dir = refraction.dir;
  if (sameSide(s.dir)) return std::nullopt;
  s.weight *= radianceScale(transport);
  return s;
}

std::optional<BsdfSample> Bsdf::sampleInterface(vec2 u, float u_lobe, Transport transport) const {
  if (wo_local_.z <= 0.0F) return std::nullopt;
  const vec3 h = sampleGgxVndf(wo_local_, material_.alpha, u);
  const float wo_h = dot(wo_local_, h);
  if (wo_h <= 0.0F) return std::nullopt;
  const float fresnel = fresnelAt(wo_h);
  const vec3 r = reflectanceAt(wo_h, fresnel), t = transmittanceFor(fresnel);
  const float sum = luminance(r) + luminance(t);
  if (sum <= 0.0F) return std::nullopt;
  const float p_reflect = luminance(r) / sum;
  const bool reflect = u_lobe < p_reflect;
  BsdfSample s;
  s.probability = reflect ? p_reflect : 1.0F - p_reflect;
  vec3 wi = reflectDir(-wo_local_, h);
  if (reflect) {
    if (wi.z <= 0.0F) return std::nullopt;
    s.pdf = p_reflect * pdfGgxVndf(wo_local_, h, material_.alpha) / (4.0F * wo_h);
    s.weight = r * (ggxG2(wi, wo_local_, material_.alpha) / ggxG1(wo_local_, material_.alpha) / p_reflect);
  } else if (index_matched_) {
    s.delta = s.transmitted = true;
    s.weight = t / (1.0F - p_reflect);
    wi = -wo_local_;
  } else if (material_.is_pane) {
    if (wi.z <= 0.0F) return std::nullopt;
    s.transmitted = true;
    s.pdf = (1.0F - p_reflect) * pdfGgxVndf(wo_local_, h, material_.alpha) / (4.0F * wo_h);
    s.weight = t * (ggxG2(wi, wo_local_, material_.alpha) / ggxG1(wo_local_, material_.alpha) / (1.0F - p_reflect));
    wi.z = -wi.z;
  } else {
    const Refraction refraction = refractDir(-wo_local_, h, ior_from_ / ior_to_);
    if (!refraction.valid || refraction.dir.z >= 0.0F) return std::nullopt;
    wi = refraction.dir;
    s.transmitted = true;
    const float denominator = ior_from_ * wo_h + ior_to_ * dot(wi, h);
    const float jacobian = ior_to_ * ior_to_ * std::abs(dot(wi, h)) / (denominator * denominator);
    s.pdf = (1.0F - p_reflect) * pdfGgxVndf(wo_local_, h, material_.alpha) * jacobian;
    s.weight = t * (ggxG2Transmission(wi, wo_local_, material_.alpha) / ggxG1(wo_local_, material_.alpha) /
                    (1.0F - p_reflect) * radianceScale(transport));
  }
  s.dir = frame_.toWorld(wi);
  if (sameSide(s.dir) == s.transmitted) return std::nullopt;
  return s;
}

}  // namespace nephroid
