// An environment as a light: radiance by direction, and directions by how bright they are.
#pragma once

#include "core/math.h"
#include "core/sampling/distribution.h"
#include "scene/scene_data.h"

namespace nephroid {

/// Texels of an environment in world directions.
class EnvironmentMap {
 public:
  explicit EnvironmentMap(const Environment& environment);
  vec3 radiance(vec3 dir_to) const;                       ///< from the direction `dir_to` points to
  vec3 sample(vec2 u, float& pdf_solid_angle) const;      ///< a direction to the environment
  float pdf(vec3 dir_to) const;                           ///< of `sample`, per solid angle
  float meanRadiance() const { return mean_luminance_; }  ///< luminance, averaged over the sphere
  const Environment& source() const { return environment_; }

 private:
  vec2 uvFromDir(vec3 dir) const;
  Environment environment_;
  float cos_rotation_, sin_rotation_;
  Distribution2D distribution_;
  float mean_luminance_ = 0.0F;
};

}  // namespace nephroid
