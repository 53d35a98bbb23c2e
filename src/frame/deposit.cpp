#include "frame/deposit.h"

#include "core/assert.h"
#include "frame/passes.h"
#include "shaders/frame/deposit_cells.comp.h"
#include "shaders/frame/deposit_rest.comp.h"

namespace nephroid {

namespace {

/// Groups of threads that go through the list of what is left.
constexpr std::uint32_t kRestGroups = 256;

gpu::ComputeDesc describe(gpu::Spirv shader, Reconstruction reconstruction, std::uint32_t views, bool directions,
                          std::uint32_t shared_layers) {
  return {
      .shader = shader,
      .bindings = {{0, kTexels}, {1, kTable}, {2, kTexture}, {3, kStorage}, {4, kStorage}, {5, kTable}, {6, kTable}},
      .push_bytes = sizeof(DepositPush),
      .constants = {{0, reconstruction == Reconstruction::kQuads}, {1, directions}, {2, views}, {3, shared_layers}}};
}

}  // namespace

Deposit::Deposit(gpu::Device& device, Reconstruction reconstruction, std::uint32_t views, bool directions,
                 std::uint32_t shared_layers)
    : device_(device),
      cells_(device, describe(shaders::deposit_cells_comp, reconstruction, views, directions, shared_layers),
             "deposit cells"),
      rest_pass_(device, describe(shaders::deposit_rest_comp, reconstruction, views, directions, shared_layers),
                 "deposit rest") {}

void Deposit::record(gpu::CommandRecorder& recorder, const PhotonBuffer& photons, const DepositSurfaces& surfaces,
                     float weight, float splat_radius, const gpu::Sampler& nearest, const FluxMap& map) {
  const PhotonBatch& batch = photons.batch;
  NEPHROID_ASSERT_LE(batch.grid_width * batch.grid_height, photons.chunks()[0].count);
  const gpu::Buffer& records = photons.chunks()[0].buffer;
  // A cell between photons more than there are photons, along each side; and how many are listed.
  const VkDeviceSize list_bytes =
      (VkDeviceSize{batch.grid_width + 1} * (batch.grid_height + 1) + 1) * sizeof(std::uint32_t);
  if (!rest_.valid() || rest_.size() < list_bytes)
    rest_ = gpu::Buffer(device_, list_bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryIntent::kDevice,
                        "cells that are left");
  const ReceiverViews none{.half = 1.0F}, &shared = surfaces.shared ? *surfaces.shared : none;
  const DepositPush push{.grid_width = batch.grid_width,
                         .grid_height = batch.grid_height,
                         .width = map.width(),
                         .height = map.height(),
                         .steps_per_watt = weight / map.quantum(),
                         .splat_radius = splat_radius,
                         .layer_count = surfaces.layer_count,
                         .axes = shared.axes,
                         .views_by_axis = shared.views_by_axis,
                         .texels_per_metre = 0.5F * static_cast<float>(map.width()) / shared.half,
                         .centre = shared.centre};
  recorder.pass("deposit", {Use(rest_, Access::kTransferWrite)},
                [&](PassCommands& commands) { commands.fill(rest_, 0, 0, sizeof(std::uint32_t)); });
  const std::vector<Use> uses{Use(records, Access::kComputeRead),
                              Use(surfaces.views, Access::kComputeRead),
                              Use(surfaces.surfaces, Access::kComputeRead),
                              Use(map.flux(), Access::kComputeWrite),
                              Use(map.tiles(), Access::kComputeWrite),
                              Use(map.lost(), Access::kComputeWrite),
                              Use(rest_, Access::kComputeWrite)};
  const auto bind = [&](PassCommands& commands, const gpu::ComputePipeline& pipeline) {
    commands.bind(pipeline);
    commands.bindResources({Bound(0, records), Bound(1, surfaces.views), Bound(2, surfaces.surfaces, nearest),
                            Bound(3, map.flux()), Bound(4, map.tiles()), Bound(5, map.lost()), Bound(6, rest_)});
    commands.pushConstants(push);
  };
  recorder.pass("deposit", uses, [&](PassCommands& commands) {
    bind(commands, cells_);
    commands.dispatch(gpu::groupsOf(batch.grid_width + 1, kPixelGroup),
                      gpu::groupsOf(batch.grid_height + 1, kPixelGroup));
  });
  recorder.pass("deposit rest", uses, [&](PassCommands& commands) {
    bind(commands, rest_pass_);
    commands.dispatch(kRestGroups);
  });
}

}  // namespace nephroid
