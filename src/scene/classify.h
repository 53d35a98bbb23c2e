// Who casts caustics, who catches them. Both follow from the material, never from a name (DESIGN: Materials).
#pragma once

#include "scene/scene_data.h"

namespace nephroid {

/// The largest microfacet alpha at which a lobe still counts as specular (an S event).
inline constexpr float kDefaultSpecularAlpha = 0.25F;
/// Normal albedo of a reflecting S lobe above which a surface generates caustics in every technique.
inline constexpr float kGeneratorAlbedo = 0.1F;

/// The numbers that decide, and the verdicts. Textured inputs are judged by their factor (the texture's upper bound).
struct Classification {
  float specular_albedo = 0;      ///< normal-incidence albedo of the reflecting S lobe
  float specular_transmission = 0;///< weight of the transmitting S lobe at normal incidence (solid only; a pane bends nothing)
  float diffuse_albedo = 0;       ///< normal-incidence albedo of all D lobes
  float alpha = 1;                ///< microfacet width
  bool is_generator = false;
  bool is_weak_generator = false; ///< has an S lobe, but too weak to be a generator in real time
  bool is_receiver = false;
  std::string reason;             ///< one clause for people: "metal, alpha 0.04 <= 0.25, albedo 0.72"
};

Classification classify(const Material& material, float specular_alpha = kDefaultSpecularAlpha);

}  // namespace nephroid
