#include "support/closed_form.h"

#include <algorithm>
#include <cmath>

namespace nephroid::closed_form {

double fresnelReflectance(double cos_i, double ior_from, double ior_to) {
  const double sin_t = ior_from / ior_to * std::sqrt(std::max(1.0 - cos_i * cos_i, 0.0));
  if (sin_t >= 1.0) return 1.0;
  const double cos_t = std::sqrt(1.0 - sin_t * sin_t);
  const double rs = (ior_from * cos_i - ior_to * cos_t) / (ior_from * cos_i + ior_to * cos_t);
  const double rp = (ior_to * cos_i - ior_from * cos_t) / (ior_to * cos_i + ior_from * cos_t);
  return 0.5 * (rs * rs + rp * rp);
}

double schlickReflectance(double cos_i, double f0) { return f0 + (1.0 - f0) * std::pow(1.0 - cos_i, 5.0); }

std::optional<dvec2> refract(dvec2 dir, dvec2 normal, double ior_from, double ior_to) {
  const double ratio = ior_from / ior_to, cos_i = -glm::dot(dir, normal);
  const dvec2 tangential = ratio * (dir + cos_i * normal);
  const double sin2_t = glm::dot(tangential, tangential);
  if (sin2_t >= 1.0) return std::nullopt;
  return tangential - std::sqrt(1.0 - sin2_t) * normal;
}

double cauchyIndex(double ior_d, double abbe, double wavelength_nm) {
  constexpr double kF = 486.1327, kD = 587.5618, kC = 656.2725;  // nm, the lines that define Abbe's number
  const auto inverse_square = [](double nm) { return 1.0 / (nm * nm); };
  const double slope = (ior_d - 1.0) / abbe / (inverse_square(kF) - inverse_square(kC));
  return ior_d + slope * (inverse_square(wavelength_nm) - inverse_square(kD));
}

void Profile::deposit(double from, double to, double flux) {
  const double a = (std::min(from, to) - lower_) / width_, b = (std::max(from, to) - lower_) / width_;
  const auto bins = static_cast<double>(flux_.size());
  if (b < 0.0 || a >= bins) return;
  const auto first = static_cast<std::size_t>(std::max(a, 0.0));
  const auto last = std::min(static_cast<std::size_t>(b), flux_.size() - 1);
  if (b <= a) {
    flux_[first] += flux;
    return;
  }
  for (std::size_t i = first; i <= last; ++i) {
    const double overlap = std::min(b, static_cast<double>(i + 1)) - std::max(a, static_cast<double>(i));
    flux_[i] += flux * std::max(overlap, 0.0) / (b - a);
  }
}

std::vector<double> Profile::perStrip(double length) const {
  std::vector<double> irradiance;
  for (const double flux : flux_) irradiance.push_back(flux / (length * width_));
  return irradiance;
}

std::vector<double> Profile::perAnnulus() const {
  std::vector<double> irradiance;
  for (std::size_t i = 0; i < flux_.size(); ++i)
    irradiance.push_back(flux_[i] / (kPiD * (edge(i + 1) * edge(i + 1) - edge(i) * edge(i))));
  return irradiance;
}

double relativeL1(const std::vector<double>& measured, const std::vector<double>& predicted) {
  double difference = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    difference += std::abs(measured[i] - predicted[i]);
    sum += predicted[i];
  }
  return difference / sum;
}

std::optional<double> findCrossing(const std::vector<double>& values, double level) {
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    const double a = values[i] - level, b = values[i + 1] - level;
    if ((a <= 0.0) == (b <= 0.0)) continue;
    return static_cast<double>(i) + a / (a - b);
  }
  return std::nullopt;
}

}  // namespace nephroid::closed_form
