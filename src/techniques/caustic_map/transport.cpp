#include "techniques/caustic_map/transport.h"

#include <algorithm>
#include <array>

#include "core/assert.h"
#include "frame/passes.h"
#include "shaders/techniques/list_cells.comp.h"
#include "shaders/techniques/transport.comp.h"

namespace nephroid {
namespace {

static_assert(sizeof(TransportPush) <= 128);

/// Of receivers: the faces of a cube.
constexpr std::uint32_t kMostReceiverViews = 6;

/// Empty lists, for all branches.
constexpr std::array<CellListHead, kCellLists> kNoCells = [] {
  std::array<CellListHead, kCellLists> heads{};
  heads.fill({.groups_x = 0, .groups_y = 1, .groups_z = 1, .count = 0});
  return heads;
}();

/// As the shader's buffer of that name.
struct Views {
  ViewRecord emission[kMostEmissionViews];
  PictureView pictures[kMostEmissionViews + kMostReceiverViews];
};

bool anyLands(const SceneBuffers& buffers) {
  return std::ranges::any_of(buffers.draws(), [](const auto& draw) { return draw.generates && draw.receives; });
}

PictureView pictureView(const ViewRecord& view) {
  return {.clip_row_x = view.clip_row_x,
          .clip_row_y = view.clip_row_y,
          .clip_row_w = view.clip_row_w,
          .forward = view.forward,
          .extent = 2.0F * std::max(glm::length(view.right), glm::length(view.up))};
}

Views viewsOf(const LightPictures& pictures) {
  NEPHROID_ASSERT_LE(pictures.emission_views.size(), std::size_t{kMostEmissionViews});
  NEPHROID_ASSERT_LE(pictures.receiver_views.size(), std::size_t{kMostReceiverViews});
  Views views{};
  std::ranges::copy(pictures.emission_views, views.emission);
  PictureView* next = std::ranges::transform(pictures.emission_views, views.pictures, pictureView).out;
  std::ranges::transform(pictures.receiver_views, next, pictureView);
  return views;
}

}  // namespace

Transport::Transport(gpu::Device& device, const SceneBuffers& buffers)
    : device_(device),
      buffers_(buffers),
      lands_(anyLands(buffers)),
      list_cells_(device,
                  {.shader = shaders::list_cells_comp,
                   .bindings = SceneBuffers::bindings({kTexture, kTable}),
                   .push_bytes = sizeof(TransportPush),
                   .constants = buffers.traits().constants()},
                  "list of cells"),
      views_(device, sizeof(Views), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryIntent::kDevice, "views of a light"),
      nothing_(device, std::max(sizeof(PhotonAccount), sizeof(kNoCells)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
               gpu::MemoryIntent::kDevice, "no accounts, no lists") {}

const gpu::ComputePipeline& Transport::pipelineFor(const LightPictures& pictures, const TransportSettings& settings) {
  const std::vector<std::uint32_t> key{
      settings.account != nullptr ? 1U : 0U,
      static_cast<std::uint32_t>(settings.search),
      static_cast<std::uint32_t>(settings.exit),
      static_cast<std::uint32_t>(pictures.emission_views.size()),
      pictures.generators.layerCount(),
      static_cast<std::uint32_t>(pictures.receiver_views.size()),
      pictures.receivers.layerCount(),
      settings.cell_lists != nullptr ? 1U : 0U,
      settings.flux == CellFlux::kEq6 ? 1U : 0U,
      lands_ && (settings.landings != nullptr || settings.account != nullptr) ? 1U : 0U};
  const auto found = pipelines_.find(key);
  if (found != pipelines_.end()) return found->second;
  std::vector<gpu::Constant> constants = buffers_.traits().pathConstants();
  for (std::uint32_t i = 0; i < key.size(); ++i) constants.push_back({20 + i, key[i]});
  gpu::ComputePipeline pipeline(device_,
                                {.shader = shaders::transport_comp,
                                 .bindings = SceneBuffers::bindings(
                                     {kTable, kTable, kTexture, kTexture, kTexture, kTexture, kTexture, kTable, kTable,
                                      kTexture, kTexture, kTexture, kTable, kTable, kTable, kTable, kTable}),
                                 .push_bytes = sizeof(TransportPush),
                                 .constants = std::move(constants)},
                                "transport");
  return pipelines_.emplace(key, std::move(pipeline)).first->second;
}

CellLists Transport::makeCellLists(std::uint32_t grid) const {
  const VkDeviceSize cells = VkDeviceSize{grid} * grid;
  const auto make = [&](VkDeviceSize bytes, VkBufferUsageFlags usage, const char* name) {
    return gpu::Buffer(device_, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | usage, gpu::MemoryIntent::kDevice, name);
  };
  return {.cells = make(sizeof(kNoCells) + 3 * cells * sizeof(std::uint32_t), VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
                        "lists of cells"),
          .forks = make(cells * sizeof(Fork), 0, "forks"),
          .interiors = make(cells * kInteriorWords * sizeof(std::uint32_t), 0, "insides of forks")};
}

void Transport::clear(gpu::CommandRecorder& recorder, const PhotonBuffer& photons) {
  const gpu::Buffer& target = photons.chunks()[0].buffer;
  recorder.pass("clear photons", {Use(target, Access::kTransferWrite)},
                [&](PassCommands& commands) { commands.fill(target, 0); });
}

void Transport::listCells(gpu::CommandRecorder& recorder, const LightPictures& pictures, const gpu::Buffer& lists,
                          const TransportPush& push) {
  recorder.upload(lists, std::as_bytes(std::span(kNoCells)));
  const std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead, {Use(pictures.first.seen(), Access::kComputeRead), Use(lists, Access::kComputeWrite)});
  recorder.pass("list of cells", uses, [&](PassCommands& commands) {
    commands.bind(list_cells_);
    commands.bindResources(buffers_.bound({Bound(7, pictures.first.seen(), buffers_.sampler()), Bound(8, lists)}));
    commands.pushConstants(push);
    const std::uint32_t groups = gpu::groupsOf(push.grid, kPixelGroup);
    commands.dispatch(groups, groups);
  });
}

void Transport::record(gpu::CommandRecorder& recorder, const LightPictures& pictures, const gpu::Buffer& lights,
                       std::uint32_t light, std::uint32_t view, const TransportSettings& settings,
                       const PhotonBuffer& photons) {
  const Views views = viewsOf(pictures);
  recorder.upload(views_, std::as_bytes(std::span(&views, 1)));
  const TransportPush push{
      .grid = settings.grid,
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
      .role = (settings.is_last ? kRoleIsLast : 0U) | (settings.follows_weaker ? kRoleIsWeaker : 0U),
      .wavelength_nm = settings.band.wavelength_nm,
      .band_weight = settings.band.weight,
      .band = settings.band_index,
      .seed = settings.seed,
      .generator_lower = pictures.generator_bounds.lower,
      .generator_upper = pictures.generator_bounds.upper,
      .scene_lower = pictures.scene_bounds.lower,
      .scene_upper = pictures.scene_bounds.upper,
      .specular_alpha = settings.specular_alpha};
  const gpu::Buffer& target = photons.chunks()[0].buffer;
  const gpu::Buffer& account = settings.account != nullptr ? *settings.account : nothing_;
  const gpu::Buffer& lists = settings.cell_lists != nullptr ? settings.cell_lists->cells : nothing_;
  const gpu::Buffer& forks = settings.cell_lists != nullptr ? settings.cell_lists->forks : nothing_;
  const gpu::Buffer& interiors = settings.cell_lists != nullptr ? settings.cell_lists->interiors : nothing_;
  if (settings.cell_lists != nullptr) {
    NEPHROID_ASSERT_EQ(settings.account, nullptr);
    NEPHROID_ASSERT_LT(settings.branch, kMostBranches);
    if (settings.branch == 0) listCells(recorder, pictures, lists, push);
    clear(recorder, photons);
  }
  std::array<const gpu::Buffer*, kLandings> landings;
  landings.fill(&nothing_);
  if (lands_ && settings.landings != nullptr) {
    NEPHROID_ASSERT_EQ(settings.account, nullptr);
    for (std::size_t i = 0; i < kLandings; ++i) {
      clear(recorder, (*settings.landings)[i]);
      landings[i] = &(*settings.landings)[i].chunks()[0].buffer;
    }
  }
  const gpu::ComputePipeline& pipeline = pipelineFor(pictures, settings);
  std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead,
      {Use(views_, Access::kComputeRead), Use(lights, Access::kComputeRead),
       Use(pictures.first.seen(), Access::kComputeRead), Use(pictures.generators.seen(), Access::kComputeRead),
       Use(pictures.generators.surfaces(), Access::kComputeRead), Use(pictures.receivers.seen(), Access::kComputeRead),
       Use(pictures.receivers.surfaces(), Access::kComputeRead),
       Use(pictures.generators.depths(), Access::kComputeRead), Use(pictures.receivers.depths(), Access::kComputeRead),
       Use(target, Access::kComputeWrite), Use(account, Access::kComputeWrite),
       Use(buffers_.neighbours(), Access::kComputeRead),
       Use(lists, settings.cell_lists != nullptr ? Access::kDispatchWrite : Access::kComputeRead)});
  if (settings.cell_lists != nullptr) {
    uses.emplace_back(forks, Access::kComputeWrite);
    uses.emplace_back(interiors, Access::kComputeWrite);
  }
  if (landings[0] != &nothing_)
    for (const gpu::Buffer* buffer : landings) uses.emplace_back(*buffer, Access::kComputeWrite);
  recorder.pass("transport", uses, [&](PassCommands& commands) {
    const gpu::Sampler& nearest = buffers_.sampler();
    commands.bind(pipeline);
    commands.bindResources(buffers_.bound(
        {Bound(7, views_), Bound(8, lights), Bound(9, pictures.first.seen(), nearest),
         Bound(10, pictures.generators.seen(), nearest), Bound(11, pictures.generators.surfaces(), nearest),
         Bound(12, pictures.receivers.seen(), nearest), Bound(13, pictures.receivers.surfaces(), nearest),
         Bound(14, target), Bound(15, account), Bound(16, buffers_.neighbours(), nearest),
         Bound(17, pictures.generators.depths(), nearest), Bound(18, pictures.receivers.depths(), nearest),
         Bound(19, lists), Bound(20, forks), Bound(21, interiors), Bound(22, *landings[0]), Bound(23, *landings[1])}));
    commands.pushConstants(push);
    if (settings.cell_lists != nullptr) {
      commands.dispatchIndirect(lists,
                                (settings.follows_weaker ? kWeakerList : settings.branch) * sizeof(CellListHead));
      return;
    }
    const std::uint32_t groups = gpu::groupsOf(settings.grid, kPixelGroup);
    commands.dispatch(groups, groups);
  });
}

}  // namespace nephroid
