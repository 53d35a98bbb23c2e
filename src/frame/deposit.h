// Photons into a picture of flux, whether the picture is a light's (a caustic map) or a camera's (a photon texture).
#pragma once

#include <cstdint>

#include "frame/deposit_levels.h"
#include "frame/flux_map.h"
#include "frame/photon_buffer.h"
#include "frame/receiver_views.h"
#include "frame/scene_buffers.h"
#include "gpu/commands.h"

namespace nephroid {

/// How flux is spread over the texels that it falls on ([shah-caustics-mapping], §III-B, §III-F).
enum class Reconstruction : std::uint8_t {
  kQuads,   ///< a cell between four photons covers what lies between the places where they end; else as kSplats
  kSplats,  ///< each photon is a Gaussian of the same size in the picture
};

/// The picture's surfaces: of each texel the place in the world and the normal, as SurfaceLayers has them.
struct DepositSurfaces {
  const gpu::Buffer& views;    ///< kMostViews ViewRecords as uniforms: of one, a cube's faces, or a ReceiverMap's
  const gpu::Image& surfaces;  ///< SurfaceLayers::surfaces
  std::uint32_t layer_count = 1;
  const ReceiverViews* shared = nullptr;  ///< of what Deposit is made for
};

/// Not thread-safe. The device must outlive it.
class Deposit {
 public:
  /// @param views       of the pictures: one, or so many faces of a cube
  /// @param directions  for maps that keep them
  /// @param shared_layers  0: what a view shows first is deposited on. Else the views are parallel, of one size, and
  /// show
  ///                    the same things from several sides, so many layers behind one another of which each has flux
  ///                    of its own (FluxMap of views · shared_layers): a cell goes to the view that its surface faces
  /// @throws ResourceError
  Deposit(gpu::Device& device, Reconstruction reconstruction, std::uint32_t views, bool directions,
          std::uint32_t shared_layers = 0);

  /// Records passes that add photons of a grid to the map. The flux of each stays what it is, whether it is spread
  /// over cells or splatted; where the picture shows another surface than the one that a photon ends on, or its other
  /// side, it goes to FluxMap::lost.
  /// @param photons        batch.grid_width × batch.grid_height, row by row, in one chunk
  /// @param weight         times which their flux is added
  /// @param splat_radius   texels at which a Gaussian of two standard deviations ends
  void record(gpu::CommandRecorder& recorder, const PhotonBuffer& photons, const DepositSurfaces& surfaces,
              float weight, float splat_radius, const FluxMap& map);
  /// Records that nothing more is added to the map: only then all of its flux is in FluxMap::flux.
  void finish(gpu::CommandRecorder& recorder, const FluxMap& map) const { levels_.finish(recorder, map); }

 private:
  gpu::Device& device_;
  std::uint32_t flux_layers_;  ///< of each view
  DepositLevels levels_;
  gpu::ComputePipeline sort_, cells_, torn_, edges_, large_, at_levels_, mixed_;
  gpu::Buffer lists_;  ///< cells that each pass leaves to the next
};

}  // namespace nephroid
