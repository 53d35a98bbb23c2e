// A rasteriser in compute, for devices that are CPUs: their drivers run compute on all cores and vertices on one.
//
// It draws fine meshes over a picture that the hardware's rasteriser has begun. A thread a triangle leaves the nearest
// depth of each pixel in a buffer and notes itself if it came nearest anywhere; those few go over their pixels again
// and write who they are where the depth is theirs. Triangles of many pixels are drawn in parts. What is seen does not
// depend on the order of threads.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "frame/scene_buffers.h"
#include "gpu/commands.h"

namespace nephroid {

/// Who finds the triangle that each pixel sees.
enum class Rasteriser : std::uint8_t {
  kAuto,      ///< the hardware's; on CPUs for each draw the faster one
  kHardware,  ///< for tests
  kCompute,   ///< for tests
};

/// What is used of a scene: never kAuto on a real GPU, and kHardware where nothing is gained or tables are too large.
Rasteriser chooseRasteriser(Rasteriser wanted, const gpu::Device& device, const SceneBuffers& buffers, int width,
                            int height);

/// Draws of a scene that a view shows, by index.
struct DrawSplit {
  std::vector<std::size_t> hardware, compute;
  std::vector<std::size_t> passable;  ///< the hardware's, after all others
};

DrawSplit splitDraws(const ViewRecord& view, const std::vector<SceneBuffers::Draw>& draws, std::uint32_t pixel_count,
                     Rasteriser rasteriser);

/// Not thread-safe. Device and buffers must outlive it.
class ComputeRaster {
 public:
  /// @throws ResourceError
  ComputeRaster(gpu::Device& device, const SceneBuffers& buffers, int width, int height);

  /// Draws instances over what is there.
  /// @param draws  of the scene, by index
  /// @param seen   R32G32_UINT, `height × width`: instance + 1 and triangle; nearer ones are written over
  /// @param depth  D32_SFLOAT, likewise: of what is there, 1 near to 0 far; stays as it is
  void record(gpu::CommandRecorder& recorder, const ViewRecord& view, const std::vector<std::size_t>& draws,
              const gpu::Image& seen, const gpu::Image& depth);

 private:
  const SceneBuffers& buffers_;
  std::uint32_t width_, height_;
  gpu::ComputePipeline triangles_, split_, parts_;
  std::array<gpu::ComputePipeline, 4> seen_passes_;
  gpu::Buffer depths_, numbers_, seen_, counts_, part_list_, items_, overtaking_;
  std::vector<std::uint32_t> first_numbers_;  ///< by draw; how many triangles there are in all
};

}  // namespace nephroid
