// A rasteriser in compute, for devices that are CPUs: their drivers run compute on all cores and vertices on one.
//
// It draws fine meshes over a picture that the hardware's rasteriser has begun. A thread a triangle leaves its depth
// and its number in each pixel that it covers, as one word of 64 bits of which the largest stays; a last pass tells who
// is seen. Triangles of many pixels are drawn in parts. What is seen does not depend on the order of threads.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "frame/raster.shared.h"
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

/// Pixels of a picture, the last ones included.
struct PixelBox {
  glm::ivec2 first, last;
};

/// Not thread-safe. Device and buffers must outlive it.
class ComputeRaster {
 public:
  /// For devices with 64-bit atomics. Records the upload of a table. @throws ResourceError
  ComputeRaster(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneBuffers& buffers, int width,
                int height);

  /// Draws instances over what is there.
  /// @param draws  of the scene, by index
  /// @param seen   R32G32_UINT, `height × width`: instance + 1 and triangle; nearer ones are written over
  /// @param depth  D32_SFLOAT, likewise: of what is there, 1 near to 0 far; stays as it is
  void record(gpu::CommandRecorder& recorder, const ViewRecord& view, const std::vector<std::size_t>& draws,
              const gpu::Image& seen, const gpu::Image& depth);

 private:
  void recordBegin(gpu::CommandRecorder& recorder, bool puts_off);
  void recordSeen(gpu::CommandRecorder& recorder, RasterPush push, const PixelBox& box, const gpu::Image& seen,
                  const gpu::Image& depth);
  std::vector<gpu::Bound> bound(std::span<const gpu::Bound> more) const;

  const SceneBuffers& buffers_;
  std::uint32_t width_, height_;
  std::array<gpu::ComputePipeline, 2> triangles_;  ///< whether some may be put off
  gpu::ComputePipeline split_, parts_, seen_pass_;
  gpu::Buffer keys_, counts_, part_list_, items_, draw_table_;
  std::vector<std::uint32_t> first_numbers_;  ///< by draw
  bool has_begun_ = false;                    ///< keys_ is empty between pictures
};

}  // namespace nephroid
