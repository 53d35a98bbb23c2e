// Irradiance at any place on what catches caustics: for what mirrors, glass and water show of it.
//
// Parallel views along the axes show the receivers from all sides (frame/receiver_views.h), in layers, so that nothing
// is hidden from all of them as it would be from a light, and no surface is seen at a grazing angle. One map holds the
// flux of all lights. Shaders look it up through frame/receiver_map.glsl.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "frame/deposit.h"
#include "frame/flux_map.h"
#include "frame/receiver_map.shared.h"
#include "frame/receiver_views.h"
#include "frame/surface_layers.h"

namespace nephroid {

static_assert(sizeof(ReceiverMapHead) == 16);
static_assert(sizeof(ReceiverView) == 48);

struct ReceiverMapSettings {
  std::uint32_t size = 512;  ///< texels along a side of each view, at the most
  Reconstruction reconstruction = Reconstruction::kQuads;
  float splat_radius = 1.5F;  ///< texels
  bool directions = false;    ///< also keeps where the light comes from
};

/// Not thread-safe. Device and buffers must outlive it.
class ReceiverMap {
 public:
  /// Of the scene as it stands now. @throws ResourceError
  ReceiverMap(gpu::Device& device, const SceneData& scene, const SceneBuffers& buffers,
              const ReceiverMapSettings& settings);
  /// Of nothing: to bind where there is none.
  explicit ReceiverMap(gpu::Device& device);

  /// Views; 0 if nothing can catch a caustic.
  std::uint32_t viewCount() const { return static_cast<std::uint32_t>(views_.views.size()); }
  /// Texels along a side of each.
  std::uint32_t size() const { return map_.width(); }

  /// Records that nothing falls on anything from now on. @param most  as FluxMap::clear
  void clear(gpu::CommandRecorder& recorder, float most);
  /// Records that the photons of a grid fall where they end. @param weight  times which their flux is added
  void add(gpu::CommandRecorder& recorder, const PhotonBuffer& photons, float weight);
  /// Records that nothing more is added: to be called before anybody looks.
  void finish(gpu::CommandRecorder& recorder) const;

  /// Of frame/receiver_map.glsl: descriptors from the binding on that it is given, what is bound to them, what is read.
  static constexpr std::uint32_t kBindings = 3;
  static std::vector<VkDescriptorType> descriptorTypes();
  void appendBound(std::uint32_t first, std::vector<gpu::Bound>& bound) const;
  void appendUses(std::vector<gpu::Use>& uses) const;
  /// Its specialisation constants.
  std::vector<gpu::Constant> constants() const;

  const FluxMap& map() const { return map_; }
  /// Flux that was added since it was cleared and is in none of the views, W: it fell on a surface that lies behind
  /// others in all of them. Waits for the device; 0 before it was first cleared. @throws ResourceError
  dvec3 readLost(gpu::Device& device) const;

 private:
  ReceiverViews views_;
  ReceiverMapSettings settings_;
  std::vector<std::size_t> draws_;           ///< that are shown, by index
  std::unique_ptr<SurfaceLayers> surfaces_;  ///< where there are views
  std::unique_ptr<Deposit> deposit_;         ///< likewise
  bool surfaces_are_drawn_ = false;
  FluxMap map_;
  gpu::Buffer head_;
  gpu::Image nothing_;  ///< where there are none
};

}  // namespace nephroid
