// The wavelengths of one path: hero-wavelength sampling [wilkie-2014], as far as it helps with clear glass.
//
// One wavelength, the hero, decides which way a path goes. Three more, spaced evenly by importance, are carried as long
// as they would have gone the same way - mirrored by dispersive glass - and share the path's contribution by the
// balance heuristic: W = Σ w_j f_j / Σ p_k, over the wavelengths' products of reflectances f and of probabilities p,
// with w_j their colours. Four together are nearly white: the variance of W is 0.05 where that of one wavelength's
// colour is
// 3. Where light is bent each wavelength has a way of its own, which no other could have found: then the hero is alone,
// with its colour. What is rough or has a diffuse part is met by the hero alone as well.
// A path that meets nothing dispersive has no wavelength and the weight 1.
#pragma once

#include <array>
#include <vector>

#include "core/math.h"
#include "core/sampling/sampler.h"
#include "core/spectrum.h"

namespace nephroid {

struct Encounter;
struct PathState;

/// How a path's wavelength is drawn when it first meets a dispersive interface.
struct SpectralMode {
  std::vector<Band> bands;  ///< empty: continuous
};

struct HeroWavelengths {
  static constexpr int kCount = 4;
  /// On all that the path carries, besides its throughput at the hero's index; may be negative.
  vec3 weight{1.0F};
  bool open = false;  ///< the other wavelengths have gone the same way so far
  // The rest is set where `open` is.
  float u = 0.0F;                   ///< of the hero, for sampleWavelength
  std::array<vec3, kCount> values;  ///< product of reflectances over the hero's, per wavelength; the hero is the first
  std::array<float, kCount> pdfs;   ///< product of probabilities over the hero's

  /// What the wavelengths would carry on average, each as the hero, over what the hero does. @pre open
  float meanOverHero() const;
};

/// Draws the path's hero if the interface is dispersive and there is none yet.
void drawWavelength(PathState& state, const Encounter& encounter, const SpectralMode& mode, Sampler& sampler);
/// From here on the hero is alone if the interface is dispersive.
void settleWavelength(PathState& state, const Encounter& encounter);
/// After an event on a smooth interface without a diffuse part: settles the hero where the path was transmitted, and
/// takes the other wavelengths along where it was mirrored. Does nothing where the interface is not dispersive.
/// @param wo         unit, to where the path came from
/// @param by_chance  the way was drawn; else it was taken for certain, and so it would have been by the others
void followWavelengths(PathState& state, const Encounter& encounter, vec3 wo, float specular_alpha, bool transmitted,
                       bool by_chance = true);

}  // namespace nephroid
