// Wavelengths and what they weigh in linear Rec. 709 RGB, for dispersive photons.
#pragma once

#include <vector>

#include "core/math.h"

namespace nephroid {

/// Visible range that is sampled; outside it the colour matching functions are below 0.5 % of their peaks.
inline constexpr float kWavelengthMin_nm = 380.0F;
inline constexpr float kWavelengthMax_nm = 720.0F;
/// The helium d line, where glTF and glass catalogues give the index.
inline constexpr float kWavelengthD_nm = 587.5618F;

/// CIE 1931 2° colour matching functions x̄, ȳ, z̄ at one wavelength: the multi-lobe fit of [wyman-2013] eq. 4 and
/// table 1, within about 1 % of the tables.
vec3 colourMatching(float wavelength_nm);

/// Colour of one wavelength of a flat spectrum, linear Rec. 709, as a density over wavelength.
///
/// Signed: most pure wavelengths lie outside the gamut. Scaled per channel so that the mean over
/// [kWavelengthMin_nm, kWavelengthMax_nm] is exactly (1, 1, 1): white light stays white when it is split and gathered.
/// @return  0 outside the range
vec3 wavelengthRgb(float wavelength_nm);

/// One wavelength that stands for a part of the spectrum.
struct Band {
  float wavelength_nm;
  vec3 weight;  ///< factor on the light's RGB; may be negative
};

/// Splits the range into bands of equal importance (see sampleWavelength).
///
/// @param count  >= 1; with one band the wavelength is kWavelengthD_nm, so the index is the material's own
/// @return       in order of wavelength; the weights sum to (1, 1, 1) up to float rounding
std::vector<Band> makeBands(int count);

/// A wavelength with density in proportion to |r| + |g| + |b| of wavelengthRgb, in cells of 1 nm.
///
/// @param u  in [0, 1)
/// @return   the weight is wavelengthRgb / ((range)·pdf); its expectation is (1, 1, 1)
Band sampleWavelength(float u);
/// Density of sampleWavelength, 1/nm; 0 outside the range.
float pdfWavelength(float wavelength_nm);
/// The u for which sampleWavelength gives the wavelength.
float invertWavelength(float wavelength_nm);

}  // namespace nephroid
