#include "frame/receiver_map.h"

#include <algorithm>
#include <cmath>

#include "core/assert.h"
#include "frame/passes.h"
#include "frame/table.h"

namespace nephroid {
namespace {

/// Texels of all views and layers together: where many views are needed, their pictures are smaller. What a photon
/// takes grows with the texels that its cell covers.
constexpr std::uint32_t kMostTexels = std::uint32_t{1} << 20;
/// Surfaces behind one another in each view, all in one texel of depths: of things that stand on others, whether or not
/// they are seen from other sides too.
constexpr std::uint32_t kLayers = 2;

// Of frame/receiver_map.glsl.
constexpr std::uint32_t kViewsConstant = 22, kLayersConstant = 23, kDirectionsConstant = 24;

std::uint32_t chooseSize(std::uint32_t wanted, std::uint32_t pictures) {
  const float fits = std::sqrt(static_cast<float>(kMostTexels) / static_cast<float>(std::max(pictures, 1U)));
  return std::min(wanted, static_cast<std::uint32_t>(fits) / kDepositTile * kDepositTile);
}

/// As the shader's block.
struct HeadAndViews {
  ReceiverMapHead head;
  ReceiverView views[kMostViews];
};

gpu::Buffer makeHead(gpu::Device& device) { return makeUniforms<HeadAndViews>(device, 1, "views of receivers"); }

/// Where things are in the views, and how much a step of the flux is, W.
HeadAndViews describe(const ReceiverViews& views, std::uint32_t size, float quantum) {
  NEPHROID_ASSERT_LE(views.views.size(), std::size_t{kMostViews});
  const auto texels = static_cast<float>(size);
  const float texel = 2.0F * views.half / texels;
  HeadAndViews made{.head = {.irradiance = quantum / (texel * texel), .texel = texel, .pad_0 = 0, .pad_1 = 0}};
  std::ranges::transform(views.views, made.views, [&](const ViewRecord& view) {
    return ReceiverView{.row_x = 0.5F * texels * (view.clip_row_x + view.clip_row_w),
                        .row_y = 0.5F * texels * (view.clip_row_y + view.clip_row_w),
                        .forward = view.forward,
                        .pad = 0.0F};
  });
  return made;
}

}  // namespace

ReceiverMap::ReceiverMap(gpu::Device& device, const SceneData& scene, const SceneBuffers& buffers,
                         const ReceiverMapSettings& settings)
    : views_(makeReceiverViews(scene, buffers.draws())), settings_(settings) {
  if (views_.views.empty()) {
    *this = ReceiverMap(device);
    return;
  }
  for (std::size_t i = 0; i < buffers.draws().size(); ++i)
    if (buffers.draws()[i].receives) draws_.push_back(i);
  const std::uint32_t pictures = viewCount() * kLayers, size = chooseSize(settings.size, pictures);
  surfaces_ =
      std::make_unique<SurfaceLayers>(device, buffers, size, viewCount(), kLayers, SurfaceLayers::Sides::kFacing);
  deposit_ = std::make_unique<Deposit>(device, settings.reconstruction, viewCount(), settings.directions, kLayers);
  map_ = FluxMap(device, size, size, pictures, settings.directions);
  head_ = makeHead(device);
}

ReceiverMap::ReceiverMap(gpu::Device& device)
    : map_(device, 1, 1, 1, false),
      head_(makeHead(device)),
      nothing_(device, {.format = kFloat4, .usage = VK_IMAGE_USAGE_STORAGE_BIT, .is_array = true}, "no receivers") {}

void ReceiverMap::clear(gpu::CommandRecorder& recorder, float most) {
  if (views_.views.empty()) return;
  if (!surfaces_are_drawn_) surfaces_->record(recorder, views_.views, draws_);
  surfaces_are_drawn_ = true;
  map_.clear(recorder, most);
  const HeadAndViews head = describe(views_, size(), map_.quantum());
  recorder.upload(head_, std::as_bytes(std::span(&head, 1)));
}

void ReceiverMap::add(gpu::CommandRecorder& recorder, const PhotonBuffer& photons, float weight) {
  if (views_.views.empty()) return;
  deposit_->record(recorder, photons, {surfaces_->views(), surfaces_->surfaces(), kLayers, &views_}, weight,
                   settings_.splat_radius, map_);
}

void ReceiverMap::finish(gpu::CommandRecorder& recorder) const {
  if (!views_.views.empty()) deposit_->finish(recorder, map_);
}

dvec3 ReceiverMap::readLost(gpu::Device& device) const {
  if (!surfaces_are_drawn_) return dvec3(0.0);
  const std::vector<std::int32_t> steps = gpu::readBackAs<std::int32_t>(device, map_.lost());
  return static_cast<double>(map_.quantum()) * dvec3(steps[0], steps[1], steps[2]);
}

std::vector<VkDescriptorType> ReceiverMap::descriptorTypes() { return {kUniforms, kStorage, kStorage}; }

void ReceiverMap::appendBound(std::uint32_t first, std::vector<Bound>& bound) const {
  bound.insert(bound.end(), {Bound(first, head_), Bound(first + 1, surfaces_ ? surfaces_->depths() : nothing_),
                             Bound(first + 2, map_.flux())});
}

void ReceiverMap::appendUses(std::vector<Use>& uses) const {
  uses.insert(uses.end(),
              {Use(head_, Access::kComputeRead), Use(surfaces_ ? surfaces_->depths() : nothing_, Access::kStorageRead),
               Use(map_.flux(), Access::kStorageRead)});
}

std::vector<gpu::Constant> ReceiverMap::constants() const {
  return {{kViewsConstant, viewCount()}, {kLayersConstant, kLayers}, {kDirectionsConstant, map_.hasDirections()}};
}

}  // namespace nephroid
