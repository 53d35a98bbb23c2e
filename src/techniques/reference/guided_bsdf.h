// Ways on from a diffuse surface, drawn by its BSDF and by what a pilot learned of the place: both count by the density
// of their mixture (Veach 1997, section 9.2.4).
#pragma once

#include <optional>

#include "techniques/reference/direction_guide.h"
#include "trace/bsdf.h"

namespace nephroid {

/// What draws a way.
enum class WayBy : std::uint8_t { kChance, kGuide, kBsdf };

class GuidedBsdf {
 public:
  /// @param lobe  of `position`; nullptr: the BSDF alone
  GuidedBsdf(const Bsdf& bsdf, const DirectionLobe* lobe, vec3 position)
      : bsdf_(bsdf), lobe_(lobe), position_(position) {}

  struct Way {
    BsdfSample sample;
    float pdf_bsdf;  ///< density by the BSDF alone
  };
  /// A way of class D for radiance. @param u, u_lobe  as Bsdf::sample takes them
  /// @param by  chance, unless as many are drawn by each: half of them by the guide
  /// @return nothing if no light comes that way
  std::optional<Way> sample(vec2 u, float u_lobe, WayBy by) const;
  /// Of a way of class D, per solid angle. @param by_bsdf  by the BSDF alone
  float pdf(vec3 dir, float by_bsdf) const;

 private:
  const Bsdf& bsdf_;
  const DirectionLobe* lobe_;
  vec3 position_;
};

}  // namespace nephroid
