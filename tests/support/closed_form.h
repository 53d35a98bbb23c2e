// What the closed forms need besides a pen: textbook optics in double precision, and profiles that are filled by
// mapping intervals.
//
// Nothing here uses core/optics or trace: a formula that shared code with what it judges would share its mistakes.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/math.h"

namespace nephroid::closed_form {

inline constexpr double kPiD = 3.141592653589793238462643383279502884;
inline constexpr double radiansD(double angle_deg) { return angle_deg * (kPiD / 180.0); }
inline constexpr double degreesD(double angle) { return angle * (180.0 / kPiD); }

/// Reflectance of a dielectric interface for unpolarised light: the mean of both of Fresnel's formulas as they stand in
/// textbooks; 1 beyond the critical angle. @param cos_i in [0, 1]
double fresnelReflectance(double cos_i, double ior_from, double ior_to);

/// Schlick's reflectance of a metal, one channel.
double schlickReflectance(double cos_i, double f0);

/// Snell's law in a plane. @param dir unit, along the light; `normal` unit, towards the side that it comes from
/// @return nothing beyond the critical angle
std::optional<dvec2> refract(dvec2 dir, dvec2 normal, double ior_from, double ior_to);

/// Index at a wavelength by Cauchy's two terms laid through n_d with Abbe number V: n_F − n_C = (n_d − 1)/V.
double cauchyIndex(double ior_d, double abbe, double wavelength_nm);

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
