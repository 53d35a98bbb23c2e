#include "frame/deposit.h"

#include <algorithm>
#include <cstddef>

#include "core/assert.h"
#include "frame/passes.h"
#include "shaders/frame/deposit_cells.comp.h"
#include "shaders/frame/deposit_edges.comp.h"
#include "shaders/frame/deposit_large.comp.h"
#include "shaders/frame/deposit_mixed.comp.h"
#include "shaders/frame/deposit_sort.comp.h"
#include "shaders/frame/deposit_torn.comp.h"

namespace nephroid {

namespace {

constexpr VkDeviceSize kHeadBytes = sizeof(DepositListsHead);

gpu::ComputeDesc describe(gpu::Spirv shader, Reconstruction reconstruction, std::uint32_t views, bool directions,
                          std::uint32_t shared_layers, bool at_levels = false) {
  return {.shader = shader,
          .bindings = {{0, kTexels},
                       {1, kUniforms},
                       {2, kStorage},
                       {3, kStorage},
                       {4, kStorage},
                       {5, kTable},
                       {6, kTable},
                       {7, kTable},
                       {8, kStorage},
                       {9, kStorage},
                       {10, kStorage}},
          .push_bytes = sizeof(DepositPush),
          .constants = {{0, reconstruction == Reconstruction::kQuads},
                        {1, directions},
                        {2, views},
                        {3, shared_layers},
                        {4, at_levels}}};
}

}  // namespace

Deposit::Deposit(gpu::Device& device, Reconstruction reconstruction, std::uint32_t views, bool directions,
                 std::uint32_t shared_layers)
    : device_(device),
      flux_layers_(std::max(shared_layers, 1U)),
      levels_(device, directions),
      sort_(device, describe(shaders::deposit_sort_comp, reconstruction, views, directions, shared_layers),
            "deposit sort"),
      cells_(device, describe(shaders::deposit_cells_comp, reconstruction, views, directions, shared_layers),
             "deposit cells"),
      torn_(device, describe(shaders::deposit_torn_comp, reconstruction, views, directions, shared_layers),
            "deposit torn"),
      edges_(device, describe(shaders::deposit_edges_comp, reconstruction, views, directions, shared_layers),
             "deposit edges"),
      large_(device, describe(shaders::deposit_large_comp, reconstruction, views, directions, shared_layers),
             "deposit large"),
      at_levels_(device, describe(shaders::deposit_large_comp, reconstruction, views, directions, shared_layers, true),
                 "deposit at levels"),
      mixed_(device, describe(shaders::deposit_mixed_comp, reconstruction, views, directions, shared_layers, true),
             "deposit mixed") {}

void Deposit::record(gpu::CommandRecorder& recorder, const PhotonBuffer& photons, const DepositSurfaces& surfaces,
                     float weight, float splat_radius, const FluxMap& map) {
  const PhotonBatch& batch = photons.batch;
  NEPHROID_ASSERT_LE(batch.grid_width * batch.grid_height, photons.chunks()[0].count);
  const gpu::Buffer& records = photons.chunks()[0].buffer;
  // A cell between photons more than there are photons, along each side.
  const VkDeviceSize cells = VkDeviceSize{batch.grid_width + 1} * (batch.grid_height + 1);
  const auto squares_along = [](std::uint32_t side) { return gpu::groupsOf(side, kDepositSquare) + 1; };
  const VkDeviceSize words =
      2 * cells + VkDeviceSize{squares_along(batch.grid_width)} * squares_along(batch.grid_height);
  const VkDeviceSize list_bytes = kHeadBytes + words * sizeof(std::uint32_t);
  if (!lists_.valid() || lists_.size() < list_bytes)
    lists_ = gpu::Buffer(device_, list_bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryIntent::kDevice,
                         "lists of cells to deposit");
  // Something has to be bound.
  const gpu::Buffer& squares = photons.squares.valid() ? photons.squares : surfaces.views;
  const ReceiverViews none{.half = 1.0F}, &shared = surfaces.shared ? *surfaces.shared : none;
  const DepositPush push{.grid_width = batch.grid_width,
                         .grid_height = batch.grid_height,
                         .width = map.width(),
                         .height = map.height(),
                         .steps_per_watt = weight / map.quantum(),
                         .splat_radius = splat_radius,
                         .layer_count = surfaces.layer_count,
                         .squares_across = photons.squaresAcross(),
                         .level_count = map.levels().count(),
                         .axes = shared.axes,
                         .views_by_axis = shared.views_by_axis,
                         .texels_per_metre = 0.5F * static_cast<float>(map.width()) / shared.half,
                         .centre = shared.centre};
  recorder.pass("deposit", {Use(lists_, Access::kTransferWrite)},
                [&](PassCommands& commands) { commands.fill(lists_, 0, 0, kHeadBytes); });
  std::vector<Use> uses{Use(records, Access::kComputeRead),
                        Use(surfaces.views, Access::kComputeRead),
                        Use(surfaces.surfaces, Access::kStorageRead),
                        Use(map.flux(), Access::kComputeWrite),
                        Use(map.tiles(), Access::kComputeWrite),
                        Use(map.lost(), Access::kComputeWrite),
                        Use(lists_, Access::kComputeWrite),
                        Use(map.levels().surfaces(), Access::kStorageRead),
                        Use(map.levels().kinds(), Access::kStorageRead),
                        Use(map.levels().flux(), Access::kComputeWrite),
                        Use(map.levels().state(), Access::kDispatchRead)};
  if (photons.squares.valid()) uses.emplace_back(photons.squares, Access::kComputeRead);
  const auto bind = [&](PassCommands& commands, const gpu::ComputePipeline& pipeline) {
    commands.bind(pipeline);
    commands.bindResources({Bound(0, records), Bound(1, surfaces.views), Bound(2, surfaces.surfaces),
                            Bound(3, map.flux()), Bound(4, map.tiles()), Bound(5, map.lost()), Bound(6, lists_),
                            Bound(7, squares), Bound(8, map.levels().surfaces()), Bound(9, map.levels().kinds()),
                            Bound(10, map.levels().flux())});
    commands.pushConstants(push);
  };
  const auto overSquares = [&](const gpu::ComputePipeline& pipeline) {
    recorder.pass("deposit sort", uses, [&](PassCommands& commands) {
      bind(commands, pipeline);
      commands.dispatch(gpu::groupsOf(squares_along(batch.grid_width), kPixelGroup),
                        gpu::groupsOf(squares_along(batch.grid_height), kPixelGroup));
    });
  };
  // The first squares lie before the first photons.
  overSquares(sort_);
  overSquares(torn_);
  const auto goThrough = [&](const char* name, const gpu::ComputePipeline& pipeline) {
    recorder.pass(name, uses, [&](PassCommands& commands) {
      bind(commands, pipeline);
      commands.dispatch(kListGroups);
    });
  };
  goThrough("deposit", cells_);
  goThrough("deposit edges", edges_);
  levels_.prepare(recorder, lists_, surfaces, flux_layers_, map);
  const auto goThroughIf = [&](const char* name, const gpu::ComputePipeline& pipeline, VkDeviceSize groups) {
    recorder.pass(name, uses, [&](PassCommands& commands) {
      bind(commands, pipeline);
      commands.dispatchIndirect(map.levels().state(), groups);
    });
  };
  goThroughIf("deposit large", large_, offsetof(FluxLevelsState, exact));
  goThroughIf("deposit at levels", at_levels_, offsetof(FluxLevelsState, at_levels));
  goThroughIf("deposit at levels", mixed_, offsetof(FluxLevelsState, at_levels));
}

}  // namespace nephroid
