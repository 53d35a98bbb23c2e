// Fresnel reflectance averaged over the hemisphere, for diffuse light at an interface.
#pragma once

namespace nephroid {

/// 2∫₀¹ F(c)·c dc for light that goes from vacuum into the medium: the fraction of diffuse light reflected.
///
/// @param ior  of the medium relative to that which the light comes from, > 0; below 1 the critical angle counts
/// @return     in [0, 1], to 1e-5; 0 at ior 1
/// @see        [walter-2007] for the use; closed form in Egan, Hilgeman and Reichman (1973).
float averageFresnelDielectric(float ior);

}  // namespace nephroid
