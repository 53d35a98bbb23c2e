// What can be chosen of caustic maps, and its names.
#pragma once

#include <cstdint>
#include <vector>

#include "frame/deposit.h"
#include "frame/receiver_map.h"
#include "core/params.h"
#include "techniques/caustic_map/transport.h"

namespace nephroid {

/// The picture that photons are deposited into.
enum class DepositTarget : std::uint8_t {
  kCamera,  ///< the pixels themselves: as sharp as they are, and made anew for each picture
  kLight,   ///< a map in the light's view, or a cube map about it, which any surface can look up
};

struct CausticMapSettings {
  std::uint32_t grid = 256;          ///< cells along a side of each of the emission's views
  std::uint32_t photon_spacing = 4;  ///< cells between photons that are followed first: TransportSettings::spacing
  std::uint32_t map_size = 256;      ///< texels along a side of each face of a point's cube map
  std::uint32_t sun_map_size = 1024;
  std::uint32_t receiver_map_size = ReceiverMapSettings{}.size;  ///< of what mirrors and glass show, at the most
  std::uint32_t layers = 4;           ///< surfaces behind one another that light is followed through, from the light
  std::uint32_t receiver_layers = 4;  ///< likewise that it may end on
  std::uint32_t internal_reflections = 2;
  bool weaker_ways = false;      ///< also follows the first way that light is sent along less than along another
  std::uint32_t iterations = 8;  ///< to find where a ray meets a generator,
  std::uint32_t receiver_iterations = 8;  ///< and a receiver
  Search search = Search::kTree;
  Exit exit = Exit::kExact;
  CellFlux flux = CellFlux::kBeam;
  float first_guess = 0.0F;       ///< of the paper's methods, m; 0: what is seen where the ray starts
  std::uint32_t max_events = 8;   ///< of class S, on the way of a photon
  std::uint32_t bands = 7;        ///< of wavelength, where a material disperses
  std::uint32_t points = 4;       ///< that a light with a size is taken for, each sample
  std::uint32_t directions = 16;  ///< likewise of the environment
  Reconstruction reconstruction = Reconstruction::kQuads;
  float splat_radius = 1.5F;  ///< texels
  float low_pass = 0.0F;      ///< texels: deviation of a Gaussian over what is deposited; 0: none
  DepositTarget target = DepositTarget::kCamera;
  /// Photons of lights without a size stay, in the middles of their cells, until a light or an object changes; else
  /// each sample has its own.
  bool emits_once = false;
};

/// With those of the frame.
std::vector<ParamSpec> makeCausticMapParams();
CausticMapSettings makeCausticMapSettings(const ParamSet& params);

}  // namespace nephroid
