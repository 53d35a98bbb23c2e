// Ways on from diffuse surfaces as a pilot learned them: towards what light came from, by place (path guiding).
//
// Places are cells of a k-d tree, each with as many lessons as the others [mueller-2017]. What a cell's light came from
// are balls around points that its paths met first, each evenly filled as it is seen from the place that asks: light
// through a prism that stands near comes from other directions a few centimetres on, but from the same prism (as
// [ruppert-2020] moves lobes of another kind). With s the mean square of what ways through a ball bring and c their
// rays, variance × cost (∫ s/p)(∫ p·c) is least where p ∝ √(s/c): noise of what is met beyond counts as well as its
// mean.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math.h"

namespace nephroid {

/// A way that a path of the pilot went on.
struct DirectionLesson {
  vec3 position{0.0F};    ///< of the surface, world, m
  vec3 dir{0.0F};         ///< unit, away from it
  float distance = 0.0F;  ///< to what was met first, m; infinite if nothing
  float pdf = 0.0F;       ///< with which it was drawn, per solid angle, > 0
  float pdf_bsdf = 0.0F;  ///< with which the BSDF alone would have
  float value = 0.0F;     ///< what came: BSDF × |cos| × radiance, as one number, >= 0
  float rays = 0.0F;      ///< that it took
};

/// Directions of one cell.
class DirectionLobe {
 public:
  /// @param lessons  of the cell, at least one; their order changes, and infinite distances
  explicit DirectionLobe(std::span<DirectionLesson> lessons);

  /// Did light come from anywhere?
  bool empty() const { return targets_.empty(); }
  /// Variance × cost of the BSDF alone over that with which the lessons were drawn: how much their guide was worth.
  double gain() const { return gain_; }
  /// A unit direction. @param position world, m, @param u in [0, 1)²
  vec3 sample(vec3 position, vec2 u) const;
  /// Per solid angle.
  float pdf(vec3 position, vec3 dir) const;

 private:
  struct Target {
    vec3 centre;           ///< world, m
    float squared_radius;  ///< m²
    float share;           ///< probability with which it is drawn
    float until;           ///< sum of the shares up to this one
  };
  void divide(std::span<DirectionLesson> lessons, vec3 from, double least);
  std::vector<Target> targets_;
  double gain_ = 1.0;
};

class DirectionGuide {
 public:
  /// Knows nothing.
  DirectionGuide() = default;
  explicit DirectionGuide(std::vector<DirectionLesson> lessons);

  /// @return nullptr where nothing is known
  const DirectionLobe* at(vec3 position) const;
  /// Forgets what was worth little; lessons that were drawn without a guide tell nothing of that.
  void keepWhatPays();
  bool empty() const { return cells_.empty(); }

 private:
  struct Cell {
    int axis = -1;            ///< −1: not divided
    float at = 0.0F;          ///< m; what lies below is in the next cell
    std::uint32_t index = 0;  ///< of the cell above, or of the lobe
  };
  void divide(std::span<DirectionLesson> lessons);
  std::vector<Cell> cells_;
  std::vector<DirectionLobe> lobes_;
  std::vector<std::uint8_t> forgotten_;  ///< by lobe
};

}  // namespace nephroid
