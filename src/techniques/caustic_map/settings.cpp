#include "techniques/caustic_map/settings.h"

#include <bit>
#include <string>

#include "techniques/realtime/realtime_render.h"

namespace nephroid {

std::vector<ParamSpec> makeCausticMapParams() {
  const CausticMapSettings defaults;
  const auto number = [](std::uint32_t value) { return static_cast<int>(value); };
  std::vector<ParamSpec> params = makeFrameParams();
  const std::vector<ParamSpec> own{
      {"grid",
       number(defaults.grid),
       8,
       2048,
       "cells",
       "along a side of each picture that a light takes of what bends it; a photon a cell",
       {}},
      {"photon-spacing",
       number(defaults.photon_spacing),
       1,
       number(kMostSpacing),
       "cells",
       "between photons that are followed first, a power of two; where these agree, those between are interpolated; 1: "
       "all are followed",
       {}},
      {"map-size",
       number(defaults.map_size),
       16,
       2048,
       "texels",
       "along a side of each face of the cube map that the light of a point is deposited into",
       {}},
      {"sun-map-size",
       number(defaults.sun_map_size),
       16,
       4096,
       "texels",
       "along a side of the map that parallel light is deposited into",
       {}},
      {"receiver-map-size",
       number(defaults.receiver_map_size),
       16,
       2048,
       "texels",
       "along a side of each view along an axis, into which light is deposited for what mirrors and glass show; fewer "
       "where "
       "a million would not do for all views",
       {}},
      {"layers",
       number(defaults.layers),
       1,
       16,
       "",
       "surfaces behind one another, as seen from the light, that light is followed through if it is in pictures",
       {}},
      {"receiver-layers",
       number(defaults.receiver_layers),
       1,
       16,
       "",
       "surfaces behind one another, as seen from the light, that light may end on if it is followed in pictures",
       {}},
      {"internal-reflections",
       number(defaults.internal_reflections),
       0,
       8,
       "",
       "inside a solid that are followed before light leaves it",
       {}},
      {"weaker-ways",
       defaults.weaker_ways,
       0,
       0,
       "",
       "whether the weaker of two ways is followed too, the first time that light which enters a solid and leaves it "
       "has "
       "both: hollow bodies, several bodies behind one another",
       {}},
      {"iterations", number(defaults.iterations), 1, 64, "", "to find where a ray meets what bends it", {}},
      {"receiver-iterations", number(defaults.receiver_iterations), 1, 64, "", "to find where it ends", {}},
      {"search",
       std::string("tree"),
       0,
       0,
       "",
       "how it is found what light meets: in a tree of all triangles; in pictures that the light has taken, by steps "
       "along the ray and Newton's method on the planes of texels; or so, and receivers as the paper and those it "
       "compares with do",
       {"tree", "planes", "iterate", "newton", "secant", "march"}},
      {"exit",
       std::string("exact"),
       0,
       0,
       "",
       "how the back face is found: as all else, or by Wyman's approximation",
       {"exact", "wyman"}},
      {"flux",
       std::string("beam"),
       0,
       0,
       "",
       "what a photon carries: the light's flux through its cell; or, for comparison, that times the cosine at the "
       "surface, as eq. 6 of the paper has it, with which a sphere loses a third of its flux",
       {"beam", "eq6"}},
      {"first-guess",
       0.0F,
       0,
       1e6,
       "m",
       "of the distance, for iterate, newton and secant; 0: what is seen where the ray starts",
       {}},
      {"bands",
       number(defaults.bands),
       1,
       12,
       "",
       "of wavelength that are followed, where a material disperses light",
       {}},
      {"points", number(defaults.points), 1, 256, "", "that a light with a size is taken for, each sample", {}},
      {"directions", number(defaults.directions), 1, 1024, "", "that the environment is taken for, each sample", {}},
      {"reconstruct",
       std::string("quads"),
       0,
       0,
       "",
       "how flux is spread: over the cells between photons, or each photon as a Gaussian splat",
       {"quads", "splats"}},
      {"target",
       std::string("camera"),
       0,
       0,
       "",
       "the picture that photons are deposited into: the camera's own pixels, or a map in the light's view",
       {"camera", "light"}},
      {"emit",
       std::string("every-frame"),
       0,
       0,
       "",
       "whether lights without a size send other photons in each sample, or keep them until something changes",
       {"every-frame", "once"}},
      {"splat-radius", defaults.splat_radius, 0.5, 32, "texels", "of a splat", {}},
      {"low-pass",
       defaults.low_pass,
       0,
       16,
       "texels",
       "standard deviation of a Gaussian that blurs what was deposited and keeps the flux of each surface, in the "
       "light's map or in the camera's pixels; 0: none",
       {}},
  };
  params.insert(params.end(), own.begin(), own.end());
  return params;
}

namespace {

Search searchOf(const std::string& name) {
  if (name == "iterate") return Search::kIterate;
  if (name == "newton") return Search::kNewton;
  if (name == "secant") return Search::kSecant;
  if (name == "march") return Search::kMarch;
  if (name == "planes") return Search::kPlanes;
  return Search::kTree;
}

}  // namespace

CausticMapSettings makeCausticMapSettings(const ParamSet& params) {
  const auto count = [&](const char* name) { return static_cast<std::uint32_t>(params.getInt(name)); };
  CausticMapSettings settings;
  settings.grid = count("grid");
  settings.photon_spacing = std::bit_floor(count("photon-spacing"));
  settings.map_size = count("map-size");
  settings.sun_map_size = count("sun-map-size");
  settings.receiver_map_size = count("receiver-map-size");
  settings.layers = count("layers");
  settings.receiver_layers = count("receiver-layers");
  settings.internal_reflections = count("internal-reflections");
  settings.weaker_ways = params.getBool("weaker-ways");
  settings.iterations = count("iterations");
  settings.receiver_iterations = count("receiver-iterations");
  settings.search = searchOf(params.getString("search"));
  settings.exit = params.getString("exit") == "wyman" ? Exit::kWyman : Exit::kExact;
  if (params.getString("flux") == "eq6") settings.flux = CellFlux::kEq6;
  settings.first_guess = params.getFloat("first-guess");
  settings.bands = count("bands");
  settings.points = count("points");
  settings.directions = count("directions");
  if (params.getString("reconstruct") == "splats") settings.reconstruction = Reconstruction::kSplats;
  if (params.getString("target") == "light") settings.target = DepositTarget::kLight;
  settings.emits_once = params.getString("emit") == "once";
  settings.splat_radius = params.getFloat("splat-radius");
  settings.low_pass = params.getFloat("low-pass");
  return settings;
}

}  // namespace nephroid
