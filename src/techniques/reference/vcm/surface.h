// A vertex of a path, seen from whichever side: what one half of a path needs to know of the other's densities.
#pragma once

#include "techniques/reference/world.h"
#include "trace/bsdf.h"

namespace nephroid {

/// Points at what it is made of, which must outlive it.
class VcmSurface {
 public:
  /// @param outer, inner  media on the side of the true normal and on the other; null: vacuum
  VcmSurface(const SurfaceMaterial& material, const SurfacePoint& point, const Material* outer, const Material* inner,
             float specular_alpha)
      : material_(material), point_(point), outer_(outer), inner_(inner), specular_alpha_(specular_alpha) {}
  /// Where a path has arrived. Without dispersion, so that a medium has one index.
  static VcmSurface ofEncounter(const Encounter& e, float specular_alpha) {
    const Interface& b = e.boundary;
    return {*e.material, e.point, b.entering ? b.from : b.to, b.entering ? b.to : b.from, specular_alpha};
  }

  const SurfacePoint& point() const { return point_; }
  const Material* outer() const { return outer_; }
  const Material* inner() const { return inner_; }
  /// In which a straight line along `dir` leaves.
  const Material* mediumTowards(vec3 dir) const { return dot(dir, point_.normal_geometric) > 0.0F ? outer_ : inner_; }
  /// |cosine| on the true surface.
  float cosine(vec3 dir) const { return std::abs(dot(dir, point_.normal_geometric)); }
  /// @param wo  unit, away from the surface, to where a path comes from
  Bsdf bsdfFrom(vec3 wo) const {
    const bool outside = dot(wo, point_.normal_geometric) > 0.0F;
    return {material_,      point_, wo, iorOf(outside ? outer_ : inner_, 0.0F), iorOf(outside ? inner_ : outer_, 0.0F),
            specular_alpha_};
  }
  /// Density of going on along `wi` by an event of the class, per solid angle, choice of the class included.
  static float densityOf(const Bsdf& bsdf, EventClass c, float pdf) {
    return pdf * (c == EventClass::kSpecular ? bsdf.specularProbability() : 1.0F - bsdf.specularProbability());
  }
  /// The same where a path comes from `wo`.
  float density(EventClass c, vec3 wo, vec3 wi) const {
    const Bsdf bsdf = bsdfFrom(wo);
    return densityOf(bsdf, c, bsdf.evaluate(c, wi, Transport::kFlux).pdf);
  }

 private:
  const SurfaceMaterial& material_;
  const SurfacePoint& point_;
  const Material* outer_;
  const Material* inner_;
  float specular_alpha_;
};

}  // namespace nephroid
