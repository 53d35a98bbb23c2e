// Who casts caustics, who catches them. Both follow from the material, never from a name (DESIGN: Materials).
#pragma once

#include "scene/scene_data.h"

namespace nephroid {

/// A lobe counts as specular (an S event) if its microfacet alpha is below this.
inline constexpr float kDefaultSpecularAlpha = 0.25F;
/// Below this microfacet width a lobe is a mirror in single precision: its half-width is under 0.02 degrees.
inline constexpr float kDeltaAlpha = 5e-4F;
/// Normal albedo of a reflecting S lobe above which a surface generates caustics in every technique.
inline constexpr float kGeneratorAlbedo = 0.1F;

/// Weight of the dielectric specular lobe over a base that does not transmit: 1 up to the alpha at which a lobe stops
/// being specular, then falling linearly to 0 at alpha 1. So a fully rough dielectric is exactly Lambertian and its
/// base colour is its whole albedo, which is what authors mean by roughness 1 and what measured albedos state;
/// single-scattering GGX at alpha 1 would add about 1.4 % of a Lambertian lobe and take 4 to 9 % from the base.
/// What transmits has a real interface at any roughness, of weight 1.
float glossOf(float alpha, float transmission);

/// The numbers that decide, and the verdicts.
struct Classification {
  float specular_albedo = 0;  ///< normal-incidence albedo of the reflecting S lobe
  float specular_transmission =
      0;                     ///< weight of the transmitting S lobe at normal incidence (a smooth pane bends nothing: 0)
  float diffuse_albedo = 0;  ///< normal-incidence albedo of all D lobes
  float alpha = 1;           ///< microfacet width
  bool is_generator = false;
  bool is_weak_generator = false;  ///< has an S lobe, but too weak to be a generator in real time
  bool is_receiver = false;
  std::string reason;  ///< one clause for people: "metal, alpha 0.04 <= 0.25, albedo 0.72"
};

/// From the material's factors alone, as if it had no textures.
Classification classify(const Material& material, float specular_alpha = kDefaultSpecularAlpha);

/// With its textures: a surface is a generator or a receiver if any texel of it is (see visitTexels). The numbers are
/// those of the most specular texel, but for `diffuse_albedo`, which is the largest.
/// @note  looks at every texel; whoever asks for many instances takes classifyMaterials
Classification classify(const SceneData& scene, const Material& material, float specular_alpha = kDefaultSpecularAlpha);

/// Of every material of the scene, with its textures: by index into `scene.materials`.
std::vector<Classification> classifyMaterials(const SceneData& scene, float specular_alpha = kDefaultSpecularAlpha);

}  // namespace nephroid
