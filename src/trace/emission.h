// Photon emission: who gets a photon, aimed at the generators without bias.
//
// Every light has an emission domain: a set of rays that holds every ray from the light to any target triangle, and as
// few others as is cheap to find out. A photon carries (flux density of the ray) / (density of drawing it), so what the
// domain leaves out is only what could not meet a target, and the sum over photons is the flux through the domain.
//
//   sun          a plane perpendicular to it, in cells; those that a target's shadow may touch are kept
//   point, spot  the sphere of directions, in equal-area cells; ditto
//   mesh         a point by area, then a direction into one of the cones about the target clusters
//   environment  a direction by radiance, then a point on one of the target clusters' discs
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/math.h"
#include "core/sampling/sampler.h"
#include "trace/emission_guide.h"
#include "trace/interior.h"
#include "trace/light_set.h"
#include "trace/trace_scene.h"

namespace nephroid {

/// A photon as it leaves its light.
struct EmittedPhoton {
  vec3 origin;
  vec3 dir;  ///< unit, along the travel of light
  vec3 flux{
      0.0F};  ///< W, as if one photon were emitted: divide by the emitted count. 0: leaves outside the light's lobe
};

/// The emission domain about a photon: how far its neighbours would be if it were alone. Squared place × squared
/// direction is the volume of phase space over which a light spreads one photon. Of a guided light it is as if photons
/// were even: cells that follow the guide would meet at its steps with unequal widths, and that is a bias.
struct EmissionExtent {
  float place = 0.0F;      ///< √area perpendicular to the ray, m; 0 for a light without a size
  float direction = 0.0F;  ///< √solid angle; 0 for a sun without a size
};

/// Boxes, spheres and triangles to aim at.
class EmissionTargets {
 public:
  /// @param is_target  by instance
  EmissionTargets(const TraceScene& scene, const std::vector<bool>& is_target);
  bool empty() const { return bounds_.empty(); }
  const Bounds& bounds() const { return bounds_; }

  struct Sphere {
    vec3 centre;
    float radius;
  };
  /// Bounding spheres of clusters of triangles, at most kMaxClusters. Built when first asked for: many lights never do.
  const std::vector<Sphere>& clusters() const;
  /// Calls `visit(corners)` for every target triangle, world space.
  template <class Visit>
  void visitTriangles(Visit&& visit) const {
    for (const std::uint32_t instance : instances_) {
      for (std::uint32_t t = 0; t < scene_.triangleCountOf(instance); ++t) {
        vec3 p[3];
        scene_.triangleCorners(instance, t, p);
        visit(p);
      }
    }
  }
  static constexpr int kMaxClusters = 64;

 private:
  std::vector<Sphere> buildClusters() const;
  const TraceScene& scene_;
  std::vector<std::uint32_t> instances_;
  Bounds bounds_;
  mutable std::once_flag clusters_built_;
  mutable std::vector<Sphere> clusters_;
};

/// Emits the photons of one light. Immutable; safe from any thread.
class Emitter {
 public:
  virtual ~Emitter() = default;
  EmittedPhoton emit(Sampler& sampler) const {
    vec3 unused;
    return emit(sampler, unused);
  }
  /// @param normal  becomes that of the side of a mesh that it leaves; zero for other lights
  virtual EmittedPhoton emit(Sampler& sampler, vec3& normal) const = 0;
  /// Density of photons, were one emitted, at the end of a ray that meets a target: per area perpendicular to it, 1/m²,
  /// and, of a light with a size, per solid angle as well, 1/(m²·sr). There, flux = radiance / density.
  virtual float arrivalDensity(const LightRay& ray) const = 0;
  /// @param photon  as it was emitted
  virtual EmissionExtent extentOf(const EmittedPhoton& photon) const = 0;
  /// Flux through the domain, W: exact for punctual lights, estimated from a pilot for the others. For sharing photons
  /// among lights, not for scaling them.
  vec3 expectedFlux() const { return expected_flux_; }
  const std::string& name() const { return name_; }
  /// Number of the light in the LightSet.
  std::uint32_t source() const { return source_; }
  /// Media that the light itself is inside of.
  const InteriorList& interior() const { return interior_; }

  /// Suns, points and spots can be guided: their place or direction is drawn from a square, by the first two numbers
  /// that `emit` takes from its sampler. Without a guide they are the place in it.
  virtual bool canBeGuided() const { return false; }
  /// From now on photons are emitted by this density over that square, or evenly without one; their flux and
  /// `arrivalDensity` are by it. @pre canBeGuided()
  void guideBy(std::optional<EmissionGuide> guide) { guide_ = std::move(guide); }

 protected:
  /// @param density  becomes that of the place in the square, 1 on average
  vec2 drawPlace(Sampler& sampler, float& density) const {
    const vec2 u = sampler.next2D();
    density = 1.0F;
    return guide_ ? guide_->warp(u, density) : u;
  }
  float densityAt(vec2 place) const { return guide_ ? guide_->densityAt(place) : 1.0F; }
  friend std::vector<std::unique_ptr<Emitter>> makeEmitters(const TraceScene&, const MaterialTable&, const LightSet&,
                                                            const EmissionTargets&);
  std::string name_;
  std::uint32_t source_ = kNone;
  vec3 expected_flux_{0.0F};
  InteriorList interior_;
  std::optional<EmissionGuide> guide_;
};

/// One emitter per light that can reach a target; none if there is no target.
std::vector<std::unique_ptr<Emitter>> makeEmitters(const TraceScene& scene, const MaterialTable& materials,
                                                   const LightSet& lights, const EmissionTargets& targets);

/// The solids that `position` is inside of: follows a ray to infinity and notes every surface that it leaves without
/// having entered. Open interfaces count by their normals, so "under water" needs no lid.
InteriorList findInterior(const TraceScene& scene, vec3 position);

}  // namespace nephroid
