#include "metrics/separable_filter.h"

#include <algorithm>
#include <cmath>

namespace nephroid {
namespace {

/// exp(−x²/2σ²) for x = 0 … radius.
std::vector<double> sampleGaussian(double sigma, int radius) {
  std::vector<double> samples;
  for (int x = 0; x <= radius; ++x) samples.push_back(std::exp(-x * x / (2.0 * sigma * sigma)));
  return samples;
}

/// @param samples  one half, from the middle outwards
Kernel makeKernel(KernelShape shape, const std::vector<double>& samples, double scale) {
  constexpr double kNegligible = 1e-9;
  double largest = 0.0;
  for (const double sample : samples) largest = std::max(largest, std::abs(sample));
  Kernel kernel{shape, {}};
  std::size_t count = samples.size();
  while (count > 1 && std::abs(samples[count - 1]) < kNegligible * largest) --count;
  for (std::size_t d = 0; d < count; ++d) kernel.weights.push_back(static_cast<float>(scale * samples[d]));
  return kernel;
}

/// Adds `scale` times the filtered values of `count` neighbours from `middle` on. @param step  from tap to tap
void accumulate(const Kernel& kernel, float scale, const float* middle, std::ptrdiff_t step, int count, float* out) {
  if (kernel.shape == KernelShape::kSmooth) {
    const float weight = scale * kernel.weights[0];
    for (int i = 0; i < count; ++i) out[i] += weight * middle[i];
  }
  for (int d = 1; d <= kernel.radius(); ++d) {
    const float weight = scale * kernel.weights[static_cast<std::size_t>(d)];
    const float* before = middle - d * step;
    const float* after = middle + d * step;
    switch (kernel.shape) {
      case KernelShape::kSmooth:
        for (int i = 0; i < count; ++i) out[i] += weight * (before[i] + after[i]);
        break;
      case KernelShape::kSlope:
        for (int i = 0; i < count; ++i) out[i] += weight * (after[i] - before[i]);
        break;
      case KernelShape::kCurvature:
        for (int i = 0; i < count; ++i) out[i] += weight * ((before[i] - middle[i]) + (after[i] - middle[i]));
        break;
    }
  }
}

}  // namespace

Kernel makeGaussian(double sigma, int radius) {
  const std::vector<double> samples = sampleGaussian(sigma, radius);
  double sum = samples[0];
  for (std::size_t x = 1; x < samples.size(); ++x) sum += 2.0 * samples[x];
  return makeKernel(KernelShape::kSmooth, samples, 1.0 / sum);
}

Kernel makeGaussianSlope(double sigma, int radius) {
  std::vector<double> samples = sampleGaussian(sigma, radius);
  double sum = 0.0;
  for (std::size_t x = 0; x < samples.size(); ++x) sum += samples[x] *= static_cast<double>(x);
  return makeKernel(KernelShape::kSlope, samples, 1.0 / sum);
}

Kernel makeGaussianCurvature(double sigma, int radius) {
  std::vector<double> samples = sampleGaussian(sigma, radius);
  double positive = 0.0, negative = 0.0;
  for (std::size_t x = 0; x < samples.size(); ++x) {
    samples[x] *= static_cast<double>(x * x) / (sigma * sigma) - 1.0;
    (samples[x] > 0.0 ? positive : negative) += (x == 0 ? 1.0 : 2.0) * samples[x];
  }
  for (double& sample : samples) sample /= sample > 0.0 ? positive : -negative;
  return makeKernel(KernelShape::kCurvature, samples, 1.0);
}

void filterAcross(const Plane& in, int border, const Kernel& kernel, Plane& out) {
  for (int y = 0; y < out.height; ++y) {
    std::fill_n(out.row(y), out.width, 0.0F);
    accumulate(kernel, 1.0F, in.row(y) + border, 1, out.width, out.row(y));
  }
}

void addFilteredDown(const Plane& in, int border, const Kernel& kernel, float scale, Plane& out) {
  for (int y = 0; y < out.height; ++y) accumulate(kernel, scale, in.row(y + border), in.width, out.width, out.row(y));
}

}  // namespace nephroid
