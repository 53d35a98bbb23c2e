// One step of any path, from the eye or from a light: on to the next surface that is there, through the media between.
#pragma once

#include <span>

#include "core/math.h"
#include "core/optics/absorption.shared.h"
#include "core/optics/dispersion.shared.h"
#include "core/sampling/sampler.h"
#include "trace/hero_wavelengths.h"
#include "trace/interior.h"
#include "trace/surface_material.h"
#include "trace/trace_scene.h"

namespace nephroid {

/// What a path is besides its ray.
struct PathState {
  Ray ray;
  InteriorList interior;
  float wavelength_nm = 0.0F;  ///< of the hero; 0 until something dispersive was met
  HeroWavelengths hero;
};

/// Index of a medium at the path's wavelength; vacuum for null.
inline float iorOf(const Material* medium, float wavelength_nm) {
  if (!medium) return 1.0F;
  if (medium->dispersion == 0.0F || wavelength_nm == 0.0F) return medium->ior;
  return dispersiveIor(medium->ior, medium->dispersion, wavelength_nm);
}

/// Where a step ended.
struct Encounter {
  bool hit = false;
  bool overflow = false;  ///< nested deeper than the interior list
  SurfacePoint point;
  const SurfaceMaterial* material = nullptr;
  SurfaceMaterial scratch;   ///< holds `*material` where it varies over the surface
  Interface boundary;        ///< for solids
  vec3 transmittance{1.0F};  ///< of the media on the way
  float distance = 0.0F;     ///< m, along the ray; infinite for a miss
  std::uint32_t rays = 0;    ///< traced on the way
};

/// Shadow rays end this far before the light, relative to its distance: the light's own surface must not block it.
inline constexpr float kShadowEnd = 1.0F - 1e-4F;

/// A straight line to a light or the camera.
struct Sightline {
  Ray ray;
  const Material* medium = nullptr;  ///< in which the line runs; null: vacuum
};

/// After an event on a surface: notes which solids the path is inside of then. @return false if nested too deep
inline bool updateInterior(const TraceScene& scene, const Encounter& e, bool transmitted, InteriorList& interior) {
  if (!e.material->is_solid) return true;
  const std::uint32_t solid = scene.solidOf(e.point.instance);
  const Material& material = *e.material->source;
  return transmitted ? crossInterface(interior, solid, material, e.boundary.entering)
                     : reflectInside(interior, solid, material, e.boundary.entering);
}

/// Everything that a path needs to know of the world.
class Walker {
 public:
  Walker(const TraceScene& scene, const MaterialTable& materials) : scene_(scene), materials_(materials) {}

  /// Moves on to the next event: through holes and through interfaces that are hidden inside other solids.
  /// On return `state.ray` starts where the last straight piece began.
  void advance(PathState& state, Sampler& sampler, Encounter& e, bool coherent = false) const;
  /// The same in pieces, for callers that trace many paths at once: `depart`, then trace `state.ray` and tell `arrive`
  /// what it met until that says the step has ended. @param hit  its instance is kNone for a miss
  static void depart(Encounter& e);
  bool arrive(PathState& state, Sampler& sampler, Encounter& e, const RayHit& hit) const;

  /// Transmittance along a straight line to a light or the camera: 0 if anything blocks, else panes and medium.
  /// @param medium  in which the line runs; null: vacuum
  vec3 visibility(const Ray& ray, const Material* medium, std::uint64_t& ray_count) const;
  /// The same for up to TraceScene::kPacketSize lines that run alike. @param visible  as many
  void visibility(std::span<const Sightline> lines, vec3* visible, std::uint64_t& ray_count) const;

  const TraceScene& scene() const { return scene_; }
  const MaterialTable& materials() const { return materials_; }

 private:
  vec3 transmittanceOf(const Material* medium, float distance) const;
  const TraceScene& scene_;
  const MaterialTable& materials_;
};

}  // namespace nephroid
