// What the pixels of a picture show, for passes that light it: the frame's own visibility, or the depth and normal
// images of somebody else. Shaders read both through frame/pixel_surface.glsl.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"
#include "frame/frame.shared.h"
#include "gpu/commands.h"

namespace nephroid {

static_assert(sizeof(ForeignViewRecord) == 80);

/// How somebody else's picture was drawn.
struct ForeignView {
  mat4 clip_from_world;        ///< Vulkan's clip space: y down, z in [0, w]; reversed or not
  bool coded_normals = false;  ///< as 0.5 + 0.5 n
};

/// @param depth  format of the depths, which says how exact they are
/// @throws UsageError if the matrix has no inverse
ForeignViewRecord makeForeignView(const ForeignView& view, VkFormat depth);

/// Does not own what it names. Device, buffers and images must outlive it.
class PixelSurfaces {
 public:
  /// @param seen    instance + 1 and triangle, by pixel
  /// @param nothing  an image to bind where none is read
  static PixelSurfaces ofFrame(const gpu::Buffer& view, const gpu::Image& seen, const gpu::Image& nothing,
                               const gpu::Sampler& sampler);
  /// @param view    a ForeignViewRecord
  /// @param normal  world space; where it is not of length 1, there is nothing
  static PixelSurfaces ofForeign(const gpu::Buffer& view, const gpu::Image& depth, const gpu::Image& normal,
                                 const gpu::Image& nothing_seen, const gpu::Sampler& sampler);

  std::uint32_t width() const { return (foreign_ ? depth_ : seen_)->desc().width; }
  std::uint32_t height() const { return (foreign_ ? depth_ : seen_)->desc().height; }

  /// ViewRecord or ForeignViewRecord.
  const gpu::Buffer& view() const { return *view_; }

  /// Of frame/pixel_surface.glsl: descriptors from binding `first` on, what is bound to them, what is read.
  static constexpr std::uint32_t kBindings = 5;
  static std::vector<VkDescriptorType> descriptorTypes();
  void appendBound(std::uint32_t first, std::vector<gpu::Bound>& bound) const;
  void appendUses(std::vector<gpu::Use>& uses) const;
  /// A pass is compiled for one kind.
  bool isForeign() const { return foreign_; }
  static gpu::Constant constant(bool foreign) { return {17, foreign}; }

 private:
  PixelSurfaces(const gpu::Buffer& view, const gpu::Image& seen, const gpu::Image& depth, const gpu::Image& normal,
                const gpu::Sampler& sampler, bool foreign)
      : view_(&view), seen_(&seen), depth_(&depth), normal_(&normal), sampler_(&sampler), foreign_(foreign) {}

  const gpu::Buffer* view_;
  const gpu::Image *seen_, *depth_, *normal_;
  const gpu::Sampler* sampler_;
  bool foreign_;
};

}  // namespace nephroid
