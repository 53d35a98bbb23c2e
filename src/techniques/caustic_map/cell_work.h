// What of an emission grid is followed, when, and what is interpolated: the passes beside transport.
//
// A branch is followed from cells that lie far apart first. Where photons about a square of them agree, those between
// are interpolated; the rest waits for the next pass, from cells half as far apart.
#pragma once

#include <cstdint>

#include "frame/photon_buffer.h"
#include "frame/scene_buffers.h"
#include "gpu/commands.h"
#include "gpu/pipeline.h"
#include "techniques/caustic_map/transport.shared.h"

namespace nephroid {

/// What branches leave to one another: lists of cells, where each cell stands, and flights where they fork.
struct CellLists {
  gpu::Buffer cells, standings, forks, interiors;
};

/// Not thread-safe. Device and buffers must outlive it.
class CellWork {
 public:
  /// @throws ResourceError
  CellWork(gpu::Device& device, const SceneBuffers& buffers);

  /// For grids of so many cells along a side. @throws ResourceError
  CellLists makeLists(std::uint32_t grid) const;

  /// Records passes that empty all lists and let those cells wait for the first branch whose light meets something that
  /// bends it.
  /// @param first  what the emission's views show: SurfaceLayers::seen
  void begin(gpu::CommandRecorder& recorder, const CellLists& lists, const gpu::Image& first,
             const TransportPush& push) const;
  /// Records a pass that lists, in TransportPush::list, what waits for a branch at TransportPush::spacing.
  void list(gpu::CommandRecorder& recorder, const CellLists& lists, const TransportPush& push) const;
  /// Records a pass that interpolates between photons at that spacing what can be, and lets it wait for the next branch
  /// if those about it do. Marks PhotonBuffer::squares, if there are any.
  void interpolate(gpu::CommandRecorder& recorder, const CellLists& lists, const gpu::Image& first,
                   const PhotonBuffer& photons, const TransportPush& push) const;

 private:
  gpu::Device& device_;
  const SceneBuffers& buffers_;
  gpu::ComputePipeline stand_, list_, interpolate_;
};

}  // namespace nephroid
