// Where walks on the specular manifold begin: places on the surfaces that may mirror or bend light.
#pragma once

#include <optional>
#include <vector>

#include "core/math.h"
#include "core/sampling/distribution.h"
#include "core/sampling/sampler.h"
#include "trace/trace_scene.h"

namespace nephroid {

/// Immutable after construction, safe from any thread.
class GeneratorSurfaces {
 public:
  /// @param wanted  by instance
  GeneratorSurfaces(const TraceScene& scene, const std::vector<bool>& wanted);

  bool empty() const { return triangles_.empty(); }
  /// A place, uniform over the area of them all; not to be called where there is none.
  vec3 sample(Sampler& sampler) const;
  /// A length of an instance, m: the radius of the sphere about its box. 0 for those not wanted.
  float scaleOf(std::uint32_t instance) const { return scale_of_instance_[instance]; }

 private:
  struct Triangle {
    std::uint32_t instance, index;
  };
  const TraceScene& scene_;
  std::vector<Triangle> triangles_;
  std::optional<Distribution1D> by_area_;
  std::vector<float> scale_of_instance_;
};

}  // namespace nephroid
