// Who casts caustics, who catches them. Both follow from the material, never from a name (DESIGN: Materials).
#pragma once

#include "core/optics/surface.shared.h"
#include "scene/scene_data.h"

namespace nephroid {

/// Normal albedo of a reflecting S lobe above which a surface generates caustics in every technique.
inline constexpr float kGeneratorAlbedo = 0.1F;

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
