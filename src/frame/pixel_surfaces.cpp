#include "frame/pixel_surfaces.h"

#include <cmath>
#include <limits>

#include "frame/passes.h"
#include "nephroid/error.h"

namespace nephroid {
namespace {

/// Steps of the depths of a format: between neighbours everywhere, and relative to the depth.
struct DepthSteps {
  float absolute = 0.0F, relative = 0.0F;
};

DepthSteps stepsOf(VkFormat format) {
  switch (format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_D16_UNORM_S8_UINT:
      return {.absolute = 1.0F / 65535.0F};
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D24_UNORM_S8_UINT:
      return {.absolute = 1.0F / 16777215.0F};
    default:
      // Floats; what interpolates them loses a few steps more than what stores them.
      return {.relative = 4.0F * std::numeric_limits<float>::epsilon()};
  }
}

bool isFinite(const mat4& m) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(m[column][row])) return false;
  return true;
}

}  // namespace

ForeignViewRecord makeForeignView(const ForeignView& view, VkFormat depth) {
  // In double precision: near and far may be a million apart.
  const glm::dmat4 clip_from_world(view.clip_from_world);
  const mat4 inverse(glm::inverse(clip_from_world));
  if (!isFinite(view.clip_from_world) || !isFinite(inverse))
    throw UsageError("the matrix from world to clip space has no inverse");
  const auto row = [&](int i) { return vec4(inverse[0][i], inverse[1][i], inverse[2][i], inverse[3][i]); };
  const DepthSteps steps = stepsOf(depth);
  return {.world_row_x = row(0),
          .world_row_y = row(1),
          .world_row_z = row(2),
          .world_row_w = row(3),
          .depth_step = steps.absolute,
          .depth_ulp = steps.relative,
          .normals_are_coded = view.coded_normals ? 1U : 0U,
          .pad = 0};
}

PixelSurfaces PixelSurfaces::ofFrame(const gpu::Buffer& view, const gpu::Image& seen, const gpu::Image& nothing,
                                     const gpu::Sampler& sampler) {
  return {view, seen, nothing, nothing, sampler, false};
}

PixelSurfaces PixelSurfaces::ofForeign(const gpu::Buffer& view, const gpu::Image& depth, const gpu::Image& normal,
                                       const gpu::Image& nothing_seen, const gpu::Sampler& sampler) {
  return {view, nothing_seen, depth, normal, sampler, true};
}

std::vector<VkDescriptorType> PixelSurfaces::descriptorTypes() {
  return {kUniforms, kUniforms, kStorage, kTexture, kTexture};
}

void PixelSurfaces::appendBound(std::uint32_t first, std::vector<Bound>& bound) const {
  // Only the buffer of the kind that is compiled is read as what it is.
  bound.insert(bound.end(), {Bound(first, *view_), Bound(first + 1, *view_), Bound(first + 2, *seen_),
                             Bound(first + 3, *depth_, *sampler_), Bound(first + 4, *normal_, *sampler_)});
}

void PixelSurfaces::appendUses(std::vector<gpu::Use>& uses) const {
  uses.emplace_back(*view_, Access::kComputeRead);
  uses.emplace_back(*seen_, Access::kStorageRead);
  uses.emplace_back(*depth_, Access::kComputeRead);
  if (normal_ != depth_) uses.emplace_back(*normal_, Access::kComputeRead);
}

}  // namespace nephroid
