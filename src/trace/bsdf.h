// How a surface scatters: one microfacet interface (mirror, metal, glass, varnish) over one diffuse base.
//
// Events follow DESIGN §2: the interface is S if it is smooth or alpha < specular_alpha, else D; the base is D;
// straight transmission through a smooth pane is no event. The two classes are kept apart everywhere (sampled,
// evaluated and weighted on their own), because a path's layer depends on the class.
//
// The formulas are those of core/optics/surface.shared.h, which shaders read too. Here they are sampled, light is
// refracted, and what depends on wo alone is computed once. GGX with visible-normal sampling ([walter-2007],
// [heitz-2018]).
#pragma once

#include <cstdint>
#include <optional>

#include "core/math.h"
#include "trace/surface_material.h"

namespace nephroid {

enum class EventClass : std::uint8_t { kSpecular, kDiffuse };

/// Near a silhouette the shading normal may look away from a path, whose true normal cannot: below this cosine the true
/// one is taken.
inline constexpr float kLeastShadingCosine = 1e-4F;

/// What a path carries decides how refraction scales it: radiance changes by the squared ratio of indices, flux does
/// not.
enum class Transport : std::uint8_t { kRadiance, kFlux };

struct BsdfValue {
  vec3 f{0.0F};      ///< 1/sr, without the cosine
  float pdf = 0.0F;  ///< of sampling this direction within the class, per solid angle
};

struct BsdfSample {
  vec3 dir;                  ///< unit, away from the surface
  vec3 weight{0.0F};         ///< f·|cos| / pdf within the class
  float pdf = 0.0F;          ///< per solid angle; 0 if delta
  float probability = 1.0F;  ///< with which reflection, or transmission, was chosen of the two
  bool delta = false;
  bool transmitted = false;  ///< through the surface
  bool pass = false;         ///< straight through a pane: no event
};

class Bsdf {
 public:
  /// @param wo              unit, away from the surface, to where the path comes from
  /// @param ior_from,ior_to indices on wo's side and behind, for a solid; for anything else ior_from is the medium's
  Bsdf(const SurfaceMaterial& material, const SurfacePoint& point, vec3 wo, float ior_from, float ior_to,
       float specular_alpha);

  /// Probability with which a path picks the S class rather than the D class: by albedo at wo.
  float specularProbability() const { return interface_is_specular_ ? interface_probability_ : 0.0F; }
  /// Expected share of flux that any event keeps, by class, at wo: what is missing from 1 is absorbed.
  vec3 interfaceAlbedo() const { return reflectance_ + transmittance_; }
  vec3 baseAlbedo() const { return base_albedo_; }
  bool hasSpecular() const { return interface_is_specular_ && interface_probability_ > 0.0F; }
  bool hasDiffuse() const { return !interface_is_specular_ || interface_probability_ < 1.0F; }
  bool interfaceIsSpecular() const { return interface_is_specular_; }
  /// True if the class has something to evaluate for a given direction (not only deltas).
  bool isEvaluable(EventClass c) const { return c == EventClass::kDiffuse ? hasDiffuse() : hasSpecular() && !smooth_; }

  /// Nothing but a smooth interface: what it does is mirror or transmit.
  bool isClear() const { return smooth_ && !hasDiffuse(); }
  /// Is the D class Lambert's, with one value for all directions that reflectsFrom() allows?
  bool hasConstantDiffuse() const;
  /// That value, if it is.
  std::optional<vec3> constantDiffuse() const;
  /// Is `wi` on wo's side of the true and the shaded surface? Light from there is reflected.
  bool reflectsFrom(vec3 wi) const { return sameSide(wi) && dot(wi, normal_) > 0.0F; }
  /// How a smooth interface mirrors.
  struct Mirroring {
    vec3 reflectance;
    float probability;  ///< with which `sample` mirrors rather than transmits
  };
  Mirroring mirroring() const;

  BsdfValue evaluate(EventClass c, vec3 wi, Transport transport) const;
  /// @param u two numbers for the direction, @param u_lobe one for the choice of lobe, all in [0, 1)
  /// @return nothing if the sample falls on the wrong side of the true surface or below the microfacets
  std::optional<BsdfSample> sample(EventClass c, vec2 u, float u_lobe, Transport transport) const;

  /// |cos| between a direction and the shading normal over the one with the geometric normal: what turns flux incident
  /// on the true surface into flux incident on the shaded one (Veach 1997, §5.3.2).
  float shadingCosineRatio(vec3 w) const;
  vec3 normal() const { return normal_; }
  /// Is `dir` behind the surface, as seen from wo?
  bool transmitsTo(vec3 dir) const { return !sameSide(dir); }

 private:
  SurfaceOptics surface() const { return makeSurfaceOptics(material_, ior_from_, ior_to_, average_fresnel_); }
  float fresnelAt(float cos_theta) const { return interfaceFresnel(surface(), cos_theta); }
  /// Not inline: three times the formulas of metals would crowd out the rest.
  vec3 reflectanceAt(float cos_theta, float fresnel) const;
  vec3 transmittanceFor(float fresnel) const { return interfaceTransmittance(surface(), fresnel); }
  vec3 baseFactorFor(float fresnel) const { return baseFactor(surface(), fresnel); }
  bool sameSide(vec3 w) const { return (dot(w, normal_geometric_) > 0.0F) == side_is_outward_; }
  BsdfValue evaluateInterface(vec3 wi_local, bool reflected, Transport transport) const;
  std::optional<BsdfSample> sampleInterface(vec2 u, float u_lobe, Transport transport) const;
  std::optional<BsdfSample> sampleSmooth(float u_lobe, Transport transport) const;
  std::optional<BsdfSample> sampleBase(vec2 u) const;
  float radianceScale(Transport transport) const;

  const SurfaceMaterial& material_;
  vec3 wo_;      ///< world
  vec3 normal_;  ///< shading normal on wo's side
  vec3 normal_geometric_;
  bool side_is_outward_;
  // Of rough interfaces only: mirrors and clear glass need no tangents.
  Frame frame_;  ///< z = normal_
  vec3 wo_local_;
  float ior_from_, ior_to_;
  float average_fresnel_ = 0.0F;  ///< of surfaces with a base only
  bool smooth_, interface_is_specular_, index_matched_;
  float interface_probability_;
  vec3 reflectance_, transmittance_, base_albedo_, base_scale_;
  vec3 base_factor_o_;  ///< of the base, at wo
};

}  // namespace nephroid
