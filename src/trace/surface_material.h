// A material at one point: textures and vertex colours resolved, constants of its optics prepared.
#pragma once

#include <vector>

#include "core/math.h"
#include "core/optics/surface.shared.h"
#include "scene/classify.h"
#include "scene/scene_data.h"
#include "trace/trace_scene.h"

namespace nephroid {

struct SurfaceMaterial {
  const Material* source = nullptr;
  vec3 base{1.0F};
  float coverage = 1.0F;  ///< share of the surface that is there (alpha mask or blend); the rest is a hole
  float metallic = 0.0F;
  float alpha = 1.0F;  ///< microfacet width; 0: smooth
  float transmission = 0.0F;
  float gloss = 0.0F;        ///< weight of the dielectric specular lobe, see `glossOf`
  vec3 specular_tint{1.0F};  ///< KHR_materials_specular
  bool is_solid = false;     ///< bounds a medium of another index
  bool is_pane = false;      ///< transmits, thin-walled
};

/// Hemispherical average of the Fresnel reflectance towards a medium of relative index `ior` (to / from), tabulated.
float averageFresnel(float ior);

/// A material between two media, as the formulas of core/optics/surface.shared.h take it. Inline, so that whoever needs
/// one formula reads only the fields that it takes.
/// @param ior_from,ior_to  indices on the side looked at and behind; behind what is not solid, of its own substance
/// @param average_fresnel  averageFresnel(ior_to / ior_from) where the base is asked for, else anything
inline SurfaceOptics makeSurfaceOptics(const SurfaceMaterial& m, float ior_from, float ior_to, float average_fresnel) {
  SurfaceOptics s{};
  s.base = m.base;
  s.metallic = m.metallic;
  s.alpha = m.alpha;
  s.transmission = m.transmission;
  s.gloss = m.gloss;
  s.specular_tint = m.specular_tint;
  s.ior_from = ior_from;
  s.ior_to = ior_to;
  s.average_fresnel = average_fresnel;
  s.is_pane = m.is_pane ? 1U : 0U;
  s.is_solid = m.is_solid ? 1U : 0U;
  // Asked of metals only: what photons meet mostly is not, and the source lies elsewhere in memory.
  if (m.metallic > 0.0F && m.source->conductor_ior) {
    s.conductor_ior = *m.source->conductor_ior;
    s.conductor_k = m.source->conductor_k;
    s.has_conductor = 1;
  }
  return s;
}

/// All materials of a scene, resolved once where nothing varies over the surface.
class MaterialTable {
 public:
  explicit MaterialTable(const TraceScene& scene);
  /// The material at a point; `scratch` holds the result where it varies.
  const SurfaceMaterial& at(const SurfacePoint& point, SurfaceMaterial& scratch) const;
  /// Emitted radiance towards the side of `outward` (true: the side of the geometric normal).
  vec3 emission(const SurfacePoint& point, bool outward) const;
  /// True if some surface lets straight rays through (panes, cut-outs): shadow rays must then look at what they meet.
  bool anyPassable() const { return any_passable_; }
  /// Material::sigmaA, which takes logarithms, of one of the scene's materials.
  vec3 sigmaAOf(const Material& material) const {
    return sigma_a_per_m_[static_cast<std::size_t>(&material - scene_.scene().materials.data())];
  }

 private:
  SurfaceMaterial resolve(const Material& material, const SurfacePoint* point) const;

  const TraceScene& scene_;
  std::vector<SurfaceMaterial> constant_;  ///< by material index
  std::vector<vec3> sigma_a_per_m_;        ///< by material index
  std::vector<bool> varies_;               ///< by instance: textures or vertex colours
  bool any_passable_ = false;
};

/// What goes straight through a surface without an event: holes and smooth thin-walled transmission,
/// baseColor·(1 − R′), R′ = 2R/(1 + R) (DESIGN §2).
/// @param cos_theta  |cosine| of incidence, @param ior_outside  of the medium on both sides
vec3 passTransmittance(const SurfaceMaterial& material, float cos_theta, float ior_outside);

}  // namespace nephroid
