// The light's half of a path as a photon makes it: its weights on the way, and the vertices it leaves.
#pragma once

#include <vector>

#include "techniques/reference/vcm/light_vertex.h"
#include "techniques/reference/vcm/surface.h"
#include "techniques/reference/vcm/techniques.h"

namespace nephroid {

/// Carried along by a photon from its light to the first D event. Every event on the way has its function here.
class VcmTrail {
 public:
  /// @param techniques  null: nothing is carried
  /// @param normal      of the light, as Emitter::emit says
  void begin(const VcmTechniques* techniques, const Emitter& emitter, vec3 origin, vec3 normal) {
    techniques_ = techniques;
    source_ = emitter.source();
    previous_ = origin, light_normal_ = normal;
  }
  bool carried() const { return techniques_ != nullptr; }

  /// At a surface. @param dir  along the travel of light  @param connects  it has a rough interface of class S
  void arrive(const SurfacePoint& point, vec3 dir, bool connects);
  /// Leaves along `dir` by an S event that `sample` drew. @param probability  of the class S
  void scatter(const VcmSurface& surface, vec3 wo, const BsdfSample& sample, float probability);

  /// Weight of being seen by the camera, at a D event, along `to_camera`.
  float weighSeenAt(const VcmSurface& surface, vec3 wo, vec3 to_camera, float importance) const;
  VcmPhoton photonAt(const SurfacePoint& point, vec3 wo, vec3 flux) const {
    return {point.position, -wo, flux, arrived_, events_};
  }
  VcmLightVertex vertexAt(const VcmSurface& surface, vec3 wo, vec3 flux, EventClass c) const {
    return {surface.point(), wo, flux, surface.outer(), surface.inner(), arrived_, events_ + 1, c};
  }
  bool connects() const { return techniques_->connects(); }

 private:
  const VcmTechniques* techniques_ = nullptr;
  std::uint32_t source_ = kNone, events_ = 0;
  vec3 previous_;  ///< vertex; first, where the light was left
  vec3 light_normal_;
  VcmPartial half_;     ///< after the last event
  VcmPartial arrived_;  ///< at the surface that was met last
};

}  // namespace nephroid
