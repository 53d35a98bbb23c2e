#include "techniques/caustic_map/cell_work.h"

#include <array>
#include <span>

#include "frame/passes.h"
#include "shaders/techniques/interpolate_photons.comp.h"
#include "shaders/techniques/list_cells.comp.h"
#include "shaders/techniques/stand_cells.comp.h"

namespace nephroid {
namespace {

/// Empty lists.
constexpr std::array<CellListHead, kCellLists> kNoCells = [] {
  std::array<CellListHead, kCellLists> heads{};
  heads.fill({.groups_x = 0, .groups_y = 1, .groups_z = 1, .count = 0});
  return heads;
}();

}  // namespace

CellWork::CellWork(gpu::Device& device, const SceneBuffers& buffers)
    : device_(device),
      buffers_(buffers),
      stand_(device,
             {.shader = shaders::stand_cells_comp,
              .bindings = SceneBuffers::bindings({kTexture, kTable}),
              .push_bytes = sizeof(TransportPush),
              .constants = buffers.traits().constants()},
             "where cells stand"),
      list_(device,
            {.shader = shaders::list_cells_comp,
             .bindings = {{0, kTable}, {1, kTable}},
             .push_bytes = sizeof(TransportPush)},
            "list of cells"),
      interpolate_(device,
                   {.shader = shaders::interpolate_photons_comp,
                    .bindings = SceneBuffers::bindings({kTexels, kTable, kTexture, kTable, kTable}),
                    .push_bytes = sizeof(TransportPush),
                    .constants = buffers.traits().constants()},
                   "interpolated photons") {}

CellLists CellWork::makeLists(std::uint32_t grid) const {
  const VkDeviceSize cells = VkDeviceSize{grid} * grid;
  const auto make = [&](VkDeviceSize bytes, VkBufferUsageFlags usage, const char* name) {
    return gpu::Buffer(device_, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | usage, gpu::MemoryIntent::kDevice, name);
  };
  return {.cells = make(sizeof(kNoCells) + 2 * cells * sizeof(std::uint32_t), VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
                        "lists of cells"),
          .standings = make(cells * sizeof(std::uint32_t), 0, "where cells stand"),
          .forks = make(cells * sizeof(Fork), 0, "forks"),
          .interiors = make(cells * kInteriorWords * sizeof(std::uint32_t), 0, "insides of forks")};
}

void CellWork::begin(gpu::CommandRecorder& recorder, const CellLists& lists, const gpu::Image& first,
                     const TransportPush& push) const {
  recorder.upload(lists.cells, std::as_bytes(std::span(kNoCells)));
  const std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead, {Use(first, Access::kComputeRead), Use(lists.standings, Access::kComputeWrite)});
  recorder.pass("list of cells", uses, [&](PassCommands& commands) {
    commands.bind(stand_);
    commands.bindResources(buffers_.bound({Bound(7, first, buffers_.sampler()), Bound(8, lists.standings)}));
    commands.pushConstants(push);
    const std::uint32_t groups = gpu::groupsOf(push.grid, kPixelGroup);
    commands.dispatch(groups, groups);
  });
}

void CellWork::list(gpu::CommandRecorder& recorder, const CellLists& lists, const TransportPush& push) const {
  recorder.pass("list of cells", {Use(lists.standings, Access::kComputeRead), Use(lists.cells, Access::kComputeWrite)},
                [&](PassCommands& commands) {
                  commands.bind(list_);
                  commands.bindResources({Bound(0, lists.standings), Bound(1, lists.cells)});
                  commands.pushConstants(push);
                  const std::uint32_t groups = gpu::groupsOf(gpu::groupsOf(push.grid, push.spacing), kPixelGroup);
                  commands.dispatch(groups, groups);
                });
}

void CellWork::interpolate(gpu::CommandRecorder& recorder, const CellLists& lists, const gpu::Image& first,
                           const PhotonBuffer& photons, const TransportPush& push) const {
  const gpu::Buffer& records = photons.chunks()[0].buffer;
  // Something has to be bound.
  const gpu::Buffer& squares = photons.squares.valid() ? photons.squares : lists.standings;
  std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead, {Use(records, Access::kComputeWrite), Use(lists.standings, Access::kComputeWrite),
                             Use(first, Access::kComputeRead)});
  if (photons.squares.valid()) uses.emplace_back(squares, Access::kComputeWrite);
  recorder.pass("interpolation", uses, [&](PassCommands& commands) {
    commands.bind(interpolate_);
    commands.bindResources(
        buffers_.bound({Bound(7, records), Bound(8, lists.standings), Bound(9, first, buffers_.sampler()),
                        Bound(10, records), Bound(11, squares)}));
    commands.pushConstants(push);
    const std::uint32_t groups = gpu::groupsOf(gpu::groupsOf(push.grid, push.spacing), kPixelGroup);
    commands.dispatch(groups, groups);
  });
}

}  // namespace nephroid
