// A chain of specular events between a receiver and a light, with its exact derivatives: what manifold next-event
// estimation [hanika-2015] walks on.
//
// The chain x1 … xk (k = 1 or 2) starts at the receiver x0 along a direction ω and follows mirrored or refracted rays
// of the real mesh, so that all events but the last obey the laws of optics by construction. The last one does where
//
//   r = P (ω_in − η ω_l) = 0,   P = 1 − n nᵀ,   η = 1 where mirrored, ior_to / ior_from where refracted,
//
// with ω_in the direction that arrives at xk, ω_l the one on to the light and n the shading normal: equal angles, or
// Snell's law, for the component along the surface. ω_in − η ω_l is the generalised half vector of [walter-2007] up to
// sign and length; unlike the unit one of [jakob-marschner-2012] eq. 5 it has a value where indices are equal, and is a
// smooth function also where the ray that arrives would be reflected totally. Where the light is on the wrong side of
// the surface, P ω_l is made longer, to 2 − sin θ, so that no direction looks like its mirror image and r leads back.
// r has two components and ω two: where [jakob-marschner-2012] solve for the offsets of all vertices, here ray
// differentials [igehy-1999] carry ∂x/∂ω and ∂ω_in/∂ω from event to event, through the turn of the interpolated
// normals.
#pragma once

#include <array>
#include <cstdint>

#include "core/optics/ray_differential.shared.h"
#include "techniques/reference/manifold/share.h"
#include "techniques/reference/world.h"

namespace nephroid {

enum class Bounce : std::uint8_t { kReflect, kTransmit };

/// Where chains begin.
class ChainReceiver {
 public:
  /// @param encounter  with the receiver; must outlive this
  /// @param interior   of the path that came to it
  /// @param wo         unit, away from the receiver, to where that path came from
  ChainReceiver(const TraceScene& scene, const Encounter& encounter, const InteriorList& interior, vec3 wo);

  const SurfacePoint& point() const { return encounter_.point; }
  /// What a ray along `dir` starts inside of; null where solids are nested too deep.
  const InteriorList* interiorTowards(vec3 dir) const;

 private:
  const Encounter& encounter_;
  vec3 wo_;
  InteriorList interiors_[2];  ///< on the side of `wo`, and on the other
  bool usable_[2];
};

/// The residual r of the last event, in two axes on the surface, and its derivative.
struct ChainConstraint {
  vec2 residual{0.0F};
  vec2 by_x{0.0F}, by_y{0.0F};  ///< change of the residual with the starting direction, along the chain's two axes
};

/// One chain. Not copyable: vertices refer to materials inside of it.
class SpecularChain {
 public:
  SpecularChain(const ReferenceWorld& world, const ChainReceiver& receiver) : world_(world), receiver_(receiver) {}
  SpecularChain(const SpecularChain&) = delete;
  SpecularChain& operator=(const SpecularChain&) = delete;

  /// Starts anew. @param dir  unit, from the receiver
  bool start(vec3 dir);
  /// On to the next surface; panes are passed. @return false if there is none that is walkable, or no room for it
  bool advance(Sampler& sampler, std::uint64_t& rays);
  /// Leaves the last vertex. @return false beyond the critical angle, and where the shading normal sends the ray
  /// through the surface or holds it back
  bool bend(Bounce bounce);
  /// Forgets every vertex from the second on.
  void keepFirst() { count_ = std::min(count_, 1); }

  int count() const { return count_; }
  vec3 dir() const { return dir_; }
  /// Axes of the starting direction's two components, unit.
  const Frame& axes() const { return axes_; }
  const Encounter& vertex(int i) const { return vertices_[i].encounter; }
  /// Shading normal of a vertex on the side of arrival, unit; the axes of its residual are those of Frame::fromZ.
  vec3 normalAt(int i) const { return vertices_[i].normal; }
  /// How the path is scattered at a vertex, seen from the receiver.
  Bsdf bsdfAt(int i) const;
  /// On the far side of the last vertex; null: vacuum.
  const Material* mediumAfter(int i, Bounce bounce) const;
  /// Of the first vertex, per unit of the starting direction along the two axes, m.
  vec3 firstShift(vec2 change) const {
    return vertices_[0].arrival.dp_dx * change.x + vertices_[0].arrival.dp_dy * change.y;
  }

  /// @param light         of a light at infinity the unit direction towards it, else its place
  ChainConstraint constrain(Bounce last, vec3 light, bool at_infinity) const;
  /// From the last vertex to the light, unit.
  vec3 towardsLight(vec3 light, bool at_infinity) const;
  /// Does the last event send light from its side to the side that the chain arrives on?
  bool joinsSides(Bounce last, vec3 to_light) const;
  /// Share of the flux that arrives, by all events (the last one by `last`) and media up to the last vertex.
  vec3 transmittance(Bounce last) const;
  /// Area on the plane of the receiver per emission domain of the light: m²/sr for one with a place, 1 for the sun.
  /// Followed from the light, as photons are: with interpolated normals the way back need not have the same spread.
  float spread(Bounce last, vec3 light, bool at_infinity) const;

 private:
  struct Vertex {
    Encounter encounter;
    vec3 dir;     ///< of arrival, from the receiver
    vec3 normal;  ///< shading, on the side of arrival
    float ior_from = 1.0F, ior_to = 1.0F;
    Bounce bounce = Bounce::kReflect;  ///< by which the chain goes on
    vec3 transmittance{1.0F};          ///< of media and panes before it
    RayDifferential arrival;           ///< of the place, and of the direction of arrival
  };
  bool arrive(Vertex& vertex, Sampler& sampler, std::uint64_t& rays);
  NormalDifferential normalDifferential(const Vertex& vertex, vec3 normal, const RayDifferential& r) const;
  RayDifferential bendDifferential(const Vertex& vertex, Bounce bounce, const RayDifferential& r, vec3 dir, vec3 normal,
                                   float ior_ratio) const;

  const ReferenceWorld& world_;
  const ChainReceiver& receiver_;
  vec3 dir_{0.0F};
  Frame axes_;
  PathState state_;
  RayDifferential differential_;  ///< of the ray that is next
  std::array<Vertex, kMaxManifoldEvents> vertices_;
  int count_ = 0;
};

}  // namespace nephroid
