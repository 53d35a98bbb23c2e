#include "closed_form/optics.h"

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

}  // namespace nephroid::closed_form
