// Filters that are products of one across and one down.
#pragma once

#include <cstddef>
#include <vector>

namespace nephroid {

/// `height × width` floats, row 0 on top.
struct Plane {
  int width = 0, height = 0;
  std::vector<float> values;

  Plane() = default;
  Plane(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  float* row(int y) { return values.data() + static_cast<std::ptrdiff_t>(y) * width; }
  const float* row(int y) const { return values.data() + static_cast<std::ptrdiff_t>(y) * width; }
};

/// What a kernel does to two values that are equally far from the middle.
enum class KernelShape {
  kSmooth,     ///< adds them; weights[0] is that of the middle
  kSlope,      ///< takes the one before from the one after
  kCurvature,  ///< adds what each is above the middle; weights[0] is not used
};

/// One dimension of a filter. Slopes and curvatures are differences, so that of equal values they are 0 to the last
/// bit: FLIP takes the root of a difference of features, which would make 3e-4 of a rounding error of 1e-7.
struct Kernel {
  KernelShape shape = KernelShape::kSmooth;
  std::vector<float> weights;  ///< weights[d]: of the two values d away

  int radius() const { return static_cast<int>(weights.size()) - 1; }
};

/// exp(−x²/2σ²) at whole x in [−radius, radius], and what follows from it. @param sigma  pixels, > 0
/// Weights below 1e-9 of the largest are left out; no sum of floats would notice them.
/// @return  sum of weights 1
Kernel makeGaussian(double sigma, int radius);
/// Its derivative, scaled so that the positive weights sum to 1 and the negative ones to −1.
Kernel makeGaussianSlope(double sigma, int radius);
/// Its second derivative, scaled likewise.
Kernel makeGaussianCurvature(double sigma, int radius);

/// Filters rows. @param border  columns of `in` on either side that `out` lacks; >= the radius
/// @param out  of in.height rows and in.width − 2·border columns
void filterAcross(const Plane& in, int border, const Kernel& kernel, Plane& out);
/// Filters columns and adds `scale` times the result to `out`, of in.height − 2·border rows and in.width columns.
void addFilteredDown(const Plane& in, int border, const Kernel& kernel, float scale, Plane& out);

}  // namespace nephroid
