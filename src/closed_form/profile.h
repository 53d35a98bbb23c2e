// Profiles of irradiance: filled by a formula that maps intervals of rays, and compared with rendered ones.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace nephroid::closed_form {

/// Flux by place, in equal bins over [lower, upper].
class Profile {
 public:
  Profile(double lower, double upper, std::size_t bins)
      : lower_(lower), width_((upper - lower) / static_cast<double>(bins)), flux_(bins, 0.0) {}

  /// Spreads flux evenly between two places, in either order. What falls outside is lost.
  ///
  /// A smooth map of a beam onto a line is a chain of such intervals. A fold, where the density is infinite, is an
  /// interval of finite flux like any other: bins compare what can be compared.
  void deposit(double from, double to, double flux);

  std::size_t size() const { return flux_.size(); }
  double edge(std::size_t i) const { return lower_ + width_ * static_cast<double>(i); }
  double centre(std::size_t i) const { return edge(i) + 0.5 * width_; }
  double flux(std::size_t i) const { return flux_[i]; }
  /// Flux per bin over `length` times the bin's width: irradiance of a picture that does not vary along `length`.
  std::vector<double> perStrip(double length) const;
  /// Flux per bin over the annulus from edge(i) to edge(i + 1): irradiance of a picture of revolution.
  std::vector<double> perAnnulus() const;

 private:
  double lower_, width_;
  std::vector<double> flux_;
};

/// Σ|E − E*| / ΣE*. @pre equal sizes
double relativeL1(const std::vector<double>& measured, const std::vector<double>& predicted);

/// Position of a quantity's crossing of `level` in a sampled rising or falling edge, linear between samples: the first
/// such place in units of samples, or nothing.
std::optional<double> findCrossing(const std::vector<double>& values, double level);

}  // namespace nephroid::closed_form
