#include "frame/deposit_levels.h"

#include <cstddef>

#include "frame/deposit.h"
#include "frame/passes.h"
#include "shaders/frame/flux_levels_describe.comp.h"
#include "shaders/frame/flux_levels_plan.comp.h"
#include "shaders/frame/flux_levels_sum.comp.h"

namespace nephroid {
namespace {

FluxLevelsPush pushOf(const FluxMap& map) {
  return {.width = map.width(),
          .height = map.height(),
          .level_count = map.levels().count(),
          .level = 0,
          .layer_count = 1,
          .flux_layers = 1,
          .picture_count = map.levels().pictureCount()};
}

gpu::ComputeDesc describeDesc(bool is_first) {
  return {.shader = shaders::flux_levels_describe_comp,
          .bindings = {{0, kStorage}, {1, kStorage}, {2, kStorage}, {3, kStorage}},
          .push_bytes = sizeof(FluxLevelsPush),
          .constants = {{0, is_first}}};
}

}  // namespace

DepositLevels::DepositLevels(gpu::Device& device, bool directions)
    : plan_(device,
            {.shader = shaders::flux_levels_plan_comp,
             .bindings = {{0, kTable}, {1, kTable}},
             .push_bytes = sizeof(FluxLevelsPush)},
            "plan of levels"),
      describe_first_(device, describeDesc(true), "what the first level shows"),
      describe_(device, describeDesc(false), "what levels show"),
      sum_(device,
           {.shader = shaders::flux_levels_sum_comp,
            .bindings = {{0, kStorage}, {1, kStorage}, {2, kStorage}, {3, kStorage}},
            .push_bytes = sizeof(FluxLevelsPush),
            .constants = {{0, directions ? 2 * kFluxChannels : kFluxChannels}}},
           "sum of levels") {}

void DepositLevels::prepare(gpu::CommandRecorder& recorder, const gpu::Buffer& lists, const DepositSurfaces& surfaces,
                            std::uint32_t flux_layers, const FluxMap& map) const {
  const FluxLevels& levels = map.levels();
  FluxLevelsPush push = pushOf(map);
  push.layer_count = surfaces.layer_count;
  push.flux_layers = flux_layers;
  recorder.pass("plan of levels", {Use(lists, Access::kComputeRead), Use(levels.state(), Access::kDispatchWrite)},
                [&](PassCommands& commands) {
                  commands.bind(plan_);
                  commands.bindResources({Bound(0, lists), Bound(1, levels.state())});
                  commands.pushConstants(push);
                  commands.dispatch(1);
                });
  if (levels.count() == 0) return;
  // One more: which texels of the last show the same.
  for (push.level = 1; push.level <= levels.count() + 1; ++push.level) {
    const std::vector<Use> uses{Use(surfaces.surfaces, Access::kStorageRead),
                                Use(levels.surfaces(), Access::kComputeWrite),
                                Use(levels.kinds(), Access::kComputeWrite), Use(levels.links(), Access::kComputeWrite),
                                Use(levels.state(), Access::kDispatchRead)};
    recorder.pass("what levels show", uses, [&](PassCommands& commands) {
      commands.bind(push.level == 1 ? describe_first_ : describe_);
      commands.bindResources({Bound(0, surfaces.surfaces), Bound(1, levels.surfaces()), Bound(2, levels.kinds()),
                              Bound(3, levels.links())});
      commands.pushConstants(push);
      commands.dispatchIndirect(levels.state(),
                                offsetof(FluxLevelsState, describe) + (push.level - 1) * sizeof(DepositGroups));
    });
  }
}

void DepositLevels::finish(gpu::CommandRecorder& recorder, const FluxMap& map) const {
  const FluxLevels& levels = map.levels();
  FluxLevelsPush push = pushOf(map);
  for (push.level = levels.count(); push.level > 0; --push.level) {
    const std::vector<Use> uses{Use(levels.flux(), Access::kComputeWrite), Use(levels.links(), Access::kStorageRead),
                                Use(map.flux(), Access::kComputeWrite), Use(map.tiles(), Access::kComputeWrite),
                                Use(levels.state(), Access::kDispatchRead)};
    recorder.pass("sum of levels", uses, [&](PassCommands& commands) {
      commands.bind(sum_);
      commands.bindResources(
          {Bound(0, levels.flux()), Bound(1, levels.links()), Bound(2, map.flux()), Bound(3, map.tiles())});
      commands.pushConstants(push);
      commands.dispatchIndirect(levels.state(),
                                offsetof(FluxLevelsState, sum) + (push.level - 1) * sizeof(DepositGroups));
    });
  }
}

}  // namespace nephroid
