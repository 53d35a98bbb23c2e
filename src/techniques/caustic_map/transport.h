// From the light to where its photons end ([shah-caustics-mapping], §III-B to D).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/spectrum.h"
#include "frame/photon_buffer.h"
#include "frame/scene_buffers.h"
#include "frame/surface_layers.h"
#include "frame/triangle_tree.h"
#include "gpu/commands.h"
#include "techniques/caustic_map/cell_work.h"
#include "techniques/caustic_map/transport.shared.h"

namespace nephroid {

/// The pictures that light is followed in.
struct LightPictures {
  std::span<const ViewRecord> emission_views;  ///< of makeEmissionViews
  Bounds generator_bounds, scene_bounds;
  std::span<const ViewRecord> receiver_views;  ///< of everything that light may reach
  const SurfaceLayers& first;                  ///< what the emission's views show of all there is; one layer
  const SurfaceLayers& generators;             ///< what they show of generators
  const SurfaceLayers& receivers;              ///< what the others show of all that is no generator: black things
                                               ///< too, and what lies behind panes if it has several layers
  const TriangleTree* tree = nullptr;          ///< of the scene: for Search::kTree, which then needs neither of the
                                               ///< last two, unless for Exit::kWyman
};

/// How it is found what light meets on its way: exactly, or in pictures that the light has taken. The last four are for
/// receivers alone, as the paper does it and what it compares with (receiver_search.glsl); what bends light is then
/// found as by kPlanes.
enum class Search : std::uint8_t {
  kTree = kSearchTree,        ///< by LightPictures::tree
  kPlanes = kSearchPlanes,    ///< Newton's method on the planes that are seen, then over the surface
  kIterate = kSearchIterate,  ///< the paper's own
  kNewton = kSearchNewton,    ///< with finite differences
  kSecant = kSearchSecant,
  kMarch = kSearchMarch,
};
/// How light leaves what it has entered: as it meets all else, or at the back face that Wyman's approximation finds.
enum class Exit : std::uint8_t { kExact = kExitExact, kWyman = kExitWyman };
/// What a photon carries: the light's flux through its cell, or that times the cosine at the surface that it meets
/// first, as eq. 6 of the paper has it. Laid out in the light's view a cell has that cosine already, so the latter
/// loses flux, of a sphere under a sun a third: for comparison.
enum class CellFlux : std::uint8_t { kBeam, kEq6 };

/// Photons on diffuse lobes of generators, which light meets on its way: the first of each path, the second.
using Landings = std::array<PhotonBuffer, kLandings>;

/// How light is followed.
struct TransportSettings {
  std::uint32_t grid = 256;  ///< cells along a side of each of the emission's views
  vec2 offset{0.5F};         ///< of the photon in its cell, in [0, 1)²
  /// 0: reflected at the first surface; b >= 1: let in, and out again at the b-th place where something gets out. No
  /// path is in two branches.
  std::uint32_t branch = 0;
  std::uint32_t max_events = 8;
  /// Part of the spectrum, of makeBands; wavelength 0: all of it as one, with the indices that materials say.
  Band band{0.0F, vec3(1.0F)};
  std::uint32_t band_index = 0;
  std::uint32_t seed = 0;                 ///< of the facets of rough surfaces: another one for each frame
  std::uint32_t iterations = 8;           ///< to find where a ray meets a generator,
  std::uint32_t receiver_iterations = 8;  ///< and a receiver
  Search search = Search::kTree;
  Exit exit = Exit::kExact;
  CellFlux flux = CellFlux::kBeam;
  float first_guess = 0.0F;  ///< of the paper's methods, m; 0: what is seen where the ray starts
  /// For the ledger (PhotonLedger::account): what stays on the way. Of no use without it, and it takes time.
  const gpu::Buffer* account = nullptr;
  /// Of makeCellLists: follows only cells that have something to say, those whose light meets a generator first, and
  /// of these in each branch those that the branch before leaves to it. The other photons are zeros, which is not
  /// valid. All branches must be recorded one after the other, from 0 on, with these settings. Not with `account`, to
  /// which all cells count.
  const CellLists* cell_lists = nullptr;
  /// With lists: photons are followed from cells so far apart along both axes first, and where they agree those between
  /// are interpolated (cell_work.h); elsewhere half as far apart, and so on. A power of two; 1: all are followed. Where
  /// light lands on generators (Transport::lands) or weaker ways are followed, all are.
  std::uint32_t spacing = 1;
  /// Where photons on generators are written, as many each as there are cells; those of other cells are zeros. Not
  /// with `account`. Where no generator is a receiver too (Transport::lands) they are not touched.
  const Landings* landings = nullptr;
  float specular_alpha = kDefaultSpecularAlpha;  ///< an interface of a larger one is a diffuse lobe
  bool is_last = false;                          ///< no branch beyond this one is followed: for the account
  /// Of branch 1: goes on along the weaker of two ways where the branch went along the stronger one, the first time
  /// that no other branch takes both. By lists it is to be recorded after all branches.
  bool follows_weaker = false;
};

/// Not thread-safe. Device and buffers must outlive it.
class Transport {
 public:
  /// @throws ResourceError
  Transport(gpu::Device& device, const SceneBuffers& buffers);

  /// Is some generator a receiver too?
  bool lands() const { return lands_; }

  /// For grids of so many cells along a side. @throws ResourceError
  CellLists makeCellLists(std::uint32_t grid) const { return cells_.makeLists(grid); }

  /// Records passes for a light and an emission view: a photon for each cell, row by row.
  /// @param lights   LightRecords
  /// @param light    of them
  /// @param view     of the emission's
  /// @param photons  of grid² photons at least, in one chunk
  void record(gpu::CommandRecorder& recorder, const LightPictures& pictures, const gpu::Buffer& lights,
              std::uint32_t light, std::uint32_t view, const TransportSettings& settings, const PhotonBuffer& photons);

 private:
  struct Flights;
  /// Makes photons zeros.
  static void clear(gpu::CommandRecorder& recorder, const PhotonBuffer& photons);
  /// Records the pass itself: over all cells, or over those of a list.
  void recordFlights(gpu::CommandRecorder& recorder, const Flights& flights, const TransportPush& push);
  void recordListed(gpu::CommandRecorder& recorder, const Flights& flights, TransportPush push);
  const gpu::ComputePipeline& pipelineFor(const LightPictures& pictures, const TransportSettings& settings);

  gpu::Device& device_;
  const SceneBuffers& buffers_;
  bool lands_;
  std::map<std::vector<std::uint32_t>, gpu::ComputePipeline> pipelines_;  ///< by what they are compiled for
  CellWork cells_;
  gpu::Buffer views_, nothing_;  ///< the latter where something has to be bound
};

}  // namespace nephroid
