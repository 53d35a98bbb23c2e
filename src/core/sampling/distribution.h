// Sampling from tables: one-dimensional (lights, triangles, wavelengths) and two-dimensional (environment maps).
//
// Immutable after construction, so free to share between threads.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/math.h"

namespace nephroid {

/// Piecewise constant density over n equal cells of [0, 1), n >= 1.
///
/// Weights must be finite and >= 0. A cell of weight 0 is never chosen, unless all weights are 0: then the density is
/// uniform, so that sampling stays defined, and total() is 0 for the caller who wants to know.
class Distribution1D {
 public:
  struct Sample {
    std::size_t index;  ///< the cell
    float offset;       ///< in [0, 1), position in the cell: u reused, uniform
    float pdf;          ///< density on [0, 1); of the discrete choice alone: probability(index)
  };

  explicit Distribution1D(std::span<const float> weights);

  std::size_t size() const { return cdf_.size() - 1; }
  /// Sum of the weights as given.
  double total() const { return total_; }

  /// @param u  in [0, 1)
  Sample sample(float u) const;
  /// Probability of a cell; they sum to 1.
  float probability(std::size_t index) const { return static_cast<float>(cdf_[index + 1] - cdf_[index]); }
  /// Density at x in [0, 1).
  float pdf(float x) const;
  /// The u whose sample is (index, offset).
  float invert(std::size_t index, float offset) const;

 private:
  std::vector<double> cdf_;  ///< size() + 1 values, from exactly 0 to exactly 1
  double total_ = 0;
};

/// Piecewise constant density over width × height equal cells of the unit square.
class Distribution2D {
 public:
  struct Sample {
    vec2 uv;    ///< in [0, 1)²; x along a row, y from row 0 on
    float pdf;  ///< density on the unit square
  };

  /// @param weights  `height × width`, row by row; zeros as in Distribution1D
  Distribution2D(std::size_t width, std::size_t height, std::span<const float> weights);

  std::size_t width() const { return rows_.front().size(); }
  std::size_t height() const { return rows_.size(); }
  /// Sum of the weights as given.
  double total() const { return marginal_.total(); }

  /// Row from u.y, position in the row from u.x.
  Sample sample(vec2 u) const;
  /// Density at uv in [0, 1)².
  float pdf(vec2 uv) const;
  /// The u whose sample is at uv; uv in a cell of positive density.
  vec2 invert(vec2 uv) const;

 private:
  std::vector<Distribution1D> rows_;
  Distribution1D marginal_;
};

/// Distribution of directions over a latitude–longitude map: each texel counts by its value and its solid angle.
///
/// @param luminance  `height × width`, row 0 at the pole θ = 0; θ = π·v, φ = 2π·u
/// @return           pdf per solid angle is that on the square divided by 2π² sin θ
Distribution2D makeLatLongDistribution(std::size_t width, std::size_t height, std::span<const float> luminance);

}  // namespace nephroid
