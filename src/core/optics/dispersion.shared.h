// Refractive index as a function of wavelength.
#ifndef NEPHROID_DISPERSION_SHARED_H
#define NEPHROID_DISPERSION_SHARED_H

#include "bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

/// Index of a medium at one wavelength, from its index and Abbe number: Cauchy's two-term formula, laid through n_d.
///
/// n(λ) = max(n_d + (n_d − 1)(d/20)(523655/λ² − 1.5168), 1). The constants follow from the Fraunhofer lines F, d and C
/// (486.1, 587.6, 656.3 nm): 1/(1/F² − 1/C²) = 523655 nm², and 523655/d² = 1.5168, so that n(F) − n(C) =
/// (n_d − 1)·d/20 = (n_d − 1)/V_d.
///
/// @param ior_d          index at the d line, >= 1
/// @param dispersion     20 / Abbe number, >= 0, as in KHR_materials_dispersion; at 0 the result is exactly ior_d
/// @param wavelength_nm  in vacuum, nm, > 0
/// @return               >= 1
NEPHROID_FN float dispersiveIor(float ior_d, float dispersion, float wavelength_nm) {
  float cauchy = 523655.0f / (wavelength_nm * wavelength_nm) - 1.5168f;
  return max(ior_d + (ior_d - 1.0f) * (dispersion / 20.0f) * cauchy, 1.0f);
}

NEPHROID_NAMESPACE_END

#endif
