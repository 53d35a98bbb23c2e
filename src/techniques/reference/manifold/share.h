// Which paths the manifold walk makes, so that photons leave out exactly those.
//
// Of L S⁺ D S* E it makes those whose light side has one or two S events, each on a surface that `isWalkable` and each
// with both directions on the sides that the shading normal says (`isSeenFromItsSide`), and whose light has a place or
// a direction of its own: every light but the environment. All other caustics are the photons'.
#pragma once

#include "trace/bsdf.h"
#include "trace/walk.h"

namespace nephroid {

inline constexpr int kMaxManifoldEvents = 2;

/// Is an event on this surface a smooth function of where light arrives? Panes and holes are no events, and their weak
/// reflections are left to photons; so are rough interfaces, those that bend each wavelength its own way, and normal
/// maps, whose derivatives nobody knows.
inline bool isWalkable(const SurfaceMaterial& material, const Interface& boundary, float specular_alpha) {
  return material.alpha == 0.0F && specular_alpha > 0.0F && !material.is_pane &&
         material.source->alpha_mode == AlphaMode::kOpaque && !material.source->normal_texture.valid() &&
         !isDispersive(boundary);
}

/// Does the shading normal look at `w` from the side on which it leaves the true surface? Near silhouettes it may not,
/// and then photons take another normal.
/// @param w  unit, away from the surface
inline bool isSeenFromItsSide(const SurfacePoint& point, vec3 w) {
  const float shaded = dot(point.normal_shading, w);
  return dot(point.normal_geometric, w) > 0.0F ? shaded > kLeastShadingCosine : shaded < -kLeastShadingCosine;
}

/// The events of a photon so far, by whom its arrival on a receiver is counted.
class ManifoldShare {
 public:
  explicit ManifoldShare(bool from_environment = false) : walkable_(!from_environment) {}
  /// After an S event. @param wo, wi  unit, away from the surface
  void add(const Encounter& e, vec3 wo, vec3 wi, float specular_alpha) {
    ++events_;
    walkable_ = walkable_ && events_ <= kMaxManifoldEvents && isWalkable(*e.material, e.boundary, specular_alpha) &&
                isSeenFromItsSide(e.point, wo) && isSeenFromItsSide(e.point, wi);
  }
  /// True: the walk makes this path.
  bool isWalked() const { return walkable_ && events_ > 0; }

 private:
  int events_ = 0;
  bool walkable_;
};

}  // namespace nephroid
