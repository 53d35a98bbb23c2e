#include "frame/deposit.h"

#include "core/assert.h"
#include "frame/passes.h"
#include "shaders/frame/deposit.comp.h"

namespace nephroid {

Deposit::Deposit(gpu::Device& device, Reconstruction reconstruction, std::uint32_t views, bool directions)
    : pipeline_(device,
                {.shader = shaders::deposit_comp,
                 .bindings = {{0, kTable}, {1, kTable}, {2, kTexture}, {3, kStorage}, {4, kStorage}, {5, kTable}},
                 .push_bytes = sizeof(DepositPush),
                 .constants = {{0, reconstruction == Reconstruction::kQuads}, {1, directions}, {2, views}}},
                "deposit") {}

void Deposit::record(gpu::CommandRecorder& recorder, const PhotonBuffer& photons, const DepositSurfaces& surfaces,
                     float weight, float splat_radius, const gpu::Sampler& nearest, const FluxMap& map) {
  const PhotonBatch& batch = photons.batch;
  NEPHROID_ASSERT_LE(batch.grid_width * batch.grid_height, photons.chunks()[0].count);
  const gpu::Buffer& records = photons.chunks()[0].buffer;
  const DepositPush push{.grid_width = batch.grid_width,
                         .grid_height = batch.grid_height,
                         .width = map.width(),
                         .height = map.height(),
                         .steps_per_watt = weight / map.quantum(),
                         .splat_radius = splat_radius,
                         .layer_count = surfaces.layer_count};
  recorder.pass(
      "deposit",
      {Use(records, Access::kComputeRead), Use(surfaces.views, Access::kComputeRead),
       Use(surfaces.surfaces, Access::kComputeRead), Use(map.flux(), Access::kComputeWrite),
       Use(map.tiles(), Access::kComputeWrite), Use(map.lost(), Access::kComputeWrite)},
      [&](PassCommands& commands) {
        commands.bind(pipeline_);
        commands.bindResources({Bound(0, records), Bound(1, surfaces.views), Bound(2, surfaces.surfaces, nearest),
                                Bound(3, map.flux()), Bound(4, map.tiles()), Bound(5, map.lost())});
        commands.pushConstants(push);
        // A cell between four photons more than there are photons, along each side.
        commands.dispatch(gpu::groupsOf(batch.grid_width + 1, kPixelGroup),
                          gpu::groupsOf(batch.grid_height + 1, kPixelGroup));
      });
}

}  // namespace nephroid
