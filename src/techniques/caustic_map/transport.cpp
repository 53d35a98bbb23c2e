#include "techniques/caustic_map/transport.h"

#include "core/assert.h"
#include "frame/passes.h"
#include "shaders/techniques/transport.comp.h"

namespace nephroid {
namespace {

static_assert(sizeof(TransportPush) <= 128);

/// Two cubes of views.
constexpr std::uint32_t kMostViews = 12;

}  // namespace

Transport::Transport(gpu::Device& device, const SceneBuffers& buffers)
    : device_(device),
      buffers_(buffers),
      views_(device, kMostViews * sizeof(ViewRecord), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryIntent::kDevice,
             "views of a light"),
      no_account_(device, sizeof(PhotonAccount), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryIntent::kDevice,
                  "no accounts") {}

const gpu::ComputePipeline& Transport::pipelineFor(const LightPictures& pictures, const TransportSettings& settings) {
  const std::vector<std::uint32_t> key{settings.account != nullptr ? 1U : 0U,
                                       static_cast<std::uint32_t>(settings.search),
                                       static_cast<std::uint32_t>(settings.exit),
                                       static_cast<std::uint32_t>(pictures.emission_views.size()),
                                       pictures.generators.layerCount(),
                                       static_cast<std::uint32_t>(pictures.receiver_views.size()),
                                       pictures.receivers.layerCount()};
  const auto found = pipelines_.find(key);
  if (found != pipelines_.end()) return found->second;
  std::vector<gpu::Constant> constants = buffers_.traits().pathConstants();
  for (std::uint32_t i = 0; i < key.size(); ++i) constants.push_back({20 + i, key[i]});
  gpu::ComputePipeline pipeline(device_,
                                {.shader = shaders::transport_comp,
                                 .bindings = SceneBuffers::bindings({kTable, kTable, kTexture, kTexture, kTexture,
                                                                     kTexture, kTexture, kTable, kTable, kTexture}),
                                 .push_bytes = sizeof(TransportPush),
                                 .constants = std::move(constants)},
                                "transport");
  return pipelines_.emplace(key, std::move(pipeline)).first->second;
}

void Transport::record(gpu::CommandRecorder& recorder, const LightPictures& pictures, const gpu::Buffer& lights,
                       std::uint32_t light, std::uint32_t view, const TransportSettings& settings,
                       const PhotonBuffer& photons) {
  NEPHROID_ASSERT_LE(pictures.emission_views.size() + pictures.receiver_views.size(), std::size_t{kMostViews});
  std::vector<ViewRecord> views(pictures.emission_views.begin(), pictures.emission_views.end());
  views.insert(views.end(), pictures.receiver_views.begin(), pictures.receiver_views.end());
  recorder.upload(views_, std::as_bytes(std::span(views)));
  const TransportPush push{.grid = settings.grid,
                           .light = light,
                           .view = view,
                           .branch = settings.branch,
                           .max_events = settings.max_events,
                           .offset = settings.offset,
                           .generator_size = static_cast<float>(pictures.generators.size()),
                           .receiver_size = static_cast<float>(pictures.receivers.size()),
                           .iterations = settings.iterations,
                           .receiver_iterations = settings.receiver_iterations,
                           .first_guess = settings.first_guess,
                           .is_last = settings.is_last ? 1U : 0U,
                           .wavelength_nm = settings.band.wavelength_nm,
                           .band_weight = settings.band.weight,
                           .band = settings.band_index,
                           .seed = settings.seed,
                           .generator_lower = pictures.generator_bounds.lower,
                           .generator_upper = pictures.generator_bounds.upper,
                           .scene_lower = pictures.scene_bounds.lower,
                           .scene_upper = pictures.scene_bounds.upper};
  const gpu::Buffer& target = photons.chunks()[0].buffer;
  const gpu::Buffer& account = settings.account != nullptr ? *settings.account : no_account_;
  const gpu::ComputePipeline& pipeline = pipelineFor(pictures, settings);
  const std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead,
      {Use(views_, Access::kComputeRead), Use(lights, Access::kComputeRead),
       Use(pictures.first.seen(), Access::kComputeRead), Use(pictures.generators.seen(), Access::kComputeRead),
       Use(pictures.generators.surfaces(), Access::kComputeRead), Use(pictures.receivers.seen(), Access::kComputeRead),
       Use(pictures.receivers.surfaces(), Access::kComputeRead), Use(target, Access::kComputeWrite),
       Use(account, Access::kComputeWrite), Use(buffers_.neighbours(), Access::kComputeRead)});
  recorder.pass("transport", uses, [&](PassCommands& commands) {
    const gpu::Sampler& nearest = buffers_.sampler();
    commands.bind(pipeline);
    commands.bindResources(buffers_.bound(
        {Bound(7, views_), Bound(8, lights), Bound(9, pictures.first.seen(), nearest),
         Bound(10, pictures.generators.seen(), nearest), Bound(11, pictures.generators.surfaces(), nearest),
         Bound(12, pictures.receivers.seen(), nearest), Bound(13, pictures.receivers.surfaces(), nearest),
         Bound(14, target), Bound(15, account), Bound(16, buffers_.neighbours(), nearest)}));
    commands.pushConstants(push);
    const std::uint32_t groups = gpu::groupsOf(settings.grid, kPixelGroup);
    commands.dispatch(groups, groups);
  });
}

}  // namespace nephroid
