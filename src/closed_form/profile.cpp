#include "closed_form/profile.h"

#include <algorithm>
#include <cmath>

#include "closed_form/optics.h"

namespace nephroid::closed_form {

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
