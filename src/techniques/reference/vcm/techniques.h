// Which techniques make paths in a pass of vertex connection and merging, and the densities that both halves share.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "techniques/reference/world.h"

namespace nephroid {

class VcmTechniques {
 public:
  /// @param emitters   of the photons  @param shares  photons of a batch, by emitter
  /// @param is_target  by instance: what photons are aimed at
  VcmTechniques(const ReferenceWorld& world, std::span<const std::unique_ptr<Emitter>> emitters,
                std::span<const std::uint32_t> shares, const std::vector<bool>& is_target);

  /// Of the kernel, for all that comes: η = π r² N.
  void setRadius(float radius) {
    radius_ = radius;
    merging_ = kPi * radius * radius * photons_;
  }
  float radius() const { return radius_; }
  float merging() const { return merging_; }
  /// N: photons of a batch, from all lights.
  float photons() const { return photons_; }

  /// Are there rough interfaces of class S, which can be connected?
  bool connects() const { return connects_; }
  /// Can a path from the eye find light beyond a receiver?
  bool eyeFindsLight() const { return connects_ || world_.lights.anyMet(); }
  /// Is this what photons meet first? Other surfaces cast no caustics.
  bool isTarget(const SurfacePoint& point) const { return is_target_[point.instance]; }

  /// Of photons at the end of a ray from a light to a target, times the light's share of them: see
  /// Emitter::arrivalDensity. 0 for a light without photons.
  float arrivalDensity(std::uint32_t source, const LightRay& ray) const {
    const Source& s = sources_[source];
    return s.emitter ? s.share * s.emitter->arrivalDensity(ray) : 0.0F;
  }
  const ReferenceWorld& world() const { return world_; }

 private:
  struct Source {
    const Emitter* emitter = nullptr;
    float share = 0.0F;
  };
  const ReferenceWorld& world_;
  std::vector<Source> sources_;  ///< by LightSet's number
  const std::vector<bool>& is_target_;
  float photons_, radius_ = 0.0F, merging_ = 0.0F;
  bool connects_;
};

}  // namespace nephroid
