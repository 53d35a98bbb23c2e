// What the closed forms need besides a pen: textbook optics in double precision.
//
// Nothing here uses core/optics or trace: a formula that shared code with what it judges would share its mistakes.
#pragma once

#include <optional>

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

}  // namespace nephroid::closed_form
