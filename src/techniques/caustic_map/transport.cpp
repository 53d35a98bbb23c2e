#include "techniques/caustic_map/transport.h"

#include <algorithm>
#include <array>

#include "core/assert.h"
#include "frame/passes.h"
#include "frame/table.h"
#include "shaders/techniques/transport.comp.h"

namespace nephroid {
namespace {

static_assert(sizeof(TransportPush) <= 128);

/// Of transport.comp.glsl's own.
constexpr std::uint32_t kFirstConstant = 30;

/// As the shader's buffer of that name.
struct Views {
  Surroundings surroundings;
  ViewRecord emission[kMostViews];
  PictureView pictures[2 * kMostViews];
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
  NEPHROID_ASSERT_LE(pictures.emission_views.size(), std::size_t{kMostViews});
  NEPHROID_ASSERT_LE(pictures.receiver_views.size(), std::size_t{kMostViews});
  Views views{};
  views.surroundings = {.generator_lower = pictures.generator_bounds.lower,
                        .generator_upper = pictures.generator_bounds.upper,
                        .scene_lower = pictures.scene_bounds.lower,
                        .scene_upper = pictures.scene_bounds.upper};
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
      cells_(device, buffers),
      views_(makeUniforms<Views>(device, 1, "views of a light")),
      nothing_(device, sizeof(CellListHead) * kCellLists, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
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
  if (pictures.tree != nullptr) std::ranges::copy(pictures.tree->constants(), std::back_inserter(constants));
  for (std::uint32_t i = 0; i < key.size(); ++i) constants.push_back({kFirstConstant + i, key[i]});
  gpu::ComputePipeline pipeline(
      device_,
      {.shader = shaders::transport_comp,
       .bindings = SceneBuffers::bindings({kUniforms, kTable, kTexture, kTexture, kTexture, kTexture, kTexture,
                                           kTable,    kTable, kTexels,  kTexture, kTexture, kTable,   kTable,
                                           kTable,    kTable, kTable,   kTexels,  kTexels,  kTable}),
       .push_bytes = sizeof(TransportPush),
       .constants = std::move(constants)},
      "transport");
  return pipelines_.emplace(key, std::move(pipeline)).first->second;
}

void Transport::clear(gpu::CommandRecorder& recorder, const PhotonBuffer& photons) {
  const gpu::Buffer& target = photons.chunks()[0].buffer;
  recorder.pass("clear photons", {Use(target, Access::kTransferWrite)},
                [&](PassCommands& commands) { commands.fill(target, 0); });
  if (!photons.squares.valid()) return;
  recorder.pass("clear photons", {Use(photons.squares, Access::kTransferWrite)},
                [&](PassCommands& commands) { commands.fill(photons.squares, 0); });
}

/// What a pass is about.
struct Transport::Flights {
  const LightPictures& pictures;
  const gpu::Buffer& lights;
  const TransportSettings& settings;
  const PhotonBuffer& photons;
};

void Transport::record(gpu::CommandRecorder& recorder, const LightPictures& pictures, const gpu::Buffer& lights,
                       std::uint32_t light, std::uint32_t view, const TransportSettings& settings,
                       const PhotonBuffer& photons) {
  const Views views = viewsOf(pictures);
  recorder.upload(views_, std::as_bytes(std::span(&views, 1)));
  const TriangleTree::Walk tree = pictures.tree != nullptr ? pictures.tree->walk() : TriangleTree::Walk{};
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
      .list = kWeakerList,
      .spacing = 1,
      .squares_across = photons.squaresAcross(),
      .wavelength_nm = settings.band.wavelength_nm,
      .band_weight = settings.band.weight,
      .band = settings.band_index,
      .seed = settings.seed,
      .specular_alpha = settings.specular_alpha,
      .tree_nodes = tree.nodes,
      .tree_grid_lower = tree.grid_lower,
      .tree_grid_scale = tree.grid_scale};
  const Flights flights{pictures, lights, settings, photons};
  if (settings.cell_lists != nullptr) clear(recorder, photons);
  if (lands_ && settings.landings != nullptr)
    for (const PhotonBuffer& landings : *settings.landings) clear(recorder, landings);
  if (settings.cell_lists != nullptr && !settings.follows_weaker) {
    recordListed(recorder, flights, push);
  } else {
    recordFlights(recorder, flights, push);
  }
}

void Transport::recordListed(gpu::CommandRecorder& recorder, const Flights& flights, TransportPush push) {
  const TransportSettings& settings = flights.settings;
  const gpu::Image& first = flights.pictures.first.seen();
  NEPHROID_ASSERT_EQ(settings.account, nullptr);
  NEPHROID_ASSERT_LT(settings.branch, kMostBranches);
  NEPHROID_ASSERT_LE(settings.spacing, kMostSpacing);
  if (settings.branch == 0) cells_.begin(recorder, *settings.cell_lists, first, push);
  push.list = settings.branch * kListsEach;
  for (push.spacing = lands_ ? 1 : settings.spacing; push.spacing > 0; push.spacing /= 2, ++push.list) {
    cells_.list(recorder, *settings.cell_lists, push);
    recordFlights(recorder, flights, push);
    if (push.spacing > 1) cells_.interpolate(recorder, *settings.cell_lists, first, flights.photons, push);
  }
}

void Transport::recordFlights(gpu::CommandRecorder& recorder, const Flights& flights, const TransportPush& push) {
  const TransportSettings& settings = flights.settings;
  const LightPictures& pictures = flights.pictures;
  const gpu::Buffer& photons = flights.photons.chunks()[0].buffer;
  const auto orNothing = [&](const gpu::Buffer* buffer) -> const gpu::Buffer& { return buffer ? *buffer : nothing_; };
  const CellLists* lists = settings.cell_lists;
  const gpu::Buffer &account = orNothing(settings.account), &cells = orNothing(lists ? &lists->cells : nullptr),
                    &standings = orNothing(lists ? &lists->standings : nullptr),
                    &forks = orNothing(lists ? &lists->forks : nullptr),
                    &interiors = orNothing(lists ? &lists->interiors : nullptr);
  const bool lands = lands_ && settings.landings != nullptr;
  std::array<const gpu::Buffer*, kLandings> landings;
  for (std::size_t i = 0; i < kLandings; ++i)
    landings[i] = lands ? &(*settings.landings)[i].chunks()[0].buffer : &nothing_;
  if (settings.search == Search::kTree) NEPHROID_ASSERT_EQ(pictures.tree == nullptr, false);
  // Something has to be bound.
  const gpu::Buffer& tree_nodes = pictures.tree != nullptr ? pictures.tree->nodes() : buffers_.neighbours();
  const gpu::Buffer& tree_triangles = pictures.tree != nullptr ? pictures.tree->triangles() : buffers_.neighbours();
  const gpu::ComputePipeline& pipeline = pipelineFor(pictures, settings);
  std::vector<Use> uses = buffers_.uses(
      Access::kComputeRead, {Use(views_, Access::kComputeRead), Use(flights.lights, Access::kComputeRead),
                             Use(pictures.first.seen(), Access::kComputeRead), Use(photons, Access::kComputeWrite),
                             Use(account, Access::kComputeWrite), Use(buffers_.neighbours(), Access::kComputeRead),
                             Use(cells, lists ? Access::kDispatchWrite : Access::kComputeRead)});
  for (const SurfaceLayers* layers : {&pictures.generators, &pictures.receivers})
    for (const gpu::Image* image : {&layers->seen(), &layers->surfaces(), &layers->depths()})
      uses.emplace_back(*image, Access::kComputeRead);
  if (pictures.tree != nullptr)
    for (const gpu::Buffer* table : {&tree_nodes, &tree_triangles}) uses.emplace_back(*table, Access::kComputeRead);
  if (lists)
    for (const gpu::Buffer* buffer : {&standings, &forks, &interiors})
      uses.emplace_back(*buffer, Access::kComputeWrite);
  if (lands)
    for (const gpu::Buffer* buffer : landings) uses.emplace_back(*buffer, Access::kComputeWrite);
  recorder.pass("transport", uses, [&](PassCommands& commands) {
    const gpu::Sampler& nearest = buffers_.sampler();
    commands.bind(pipeline);
    commands.bindResources(buffers_.bound({Bound(7, views_),
                                           Bound(8, flights.lights),
                                           Bound(9, pictures.first.seen(), nearest),
                                           Bound(10, pictures.generators.seen(), nearest),
                                           Bound(11, pictures.generators.surfaces(), nearest),
                                           Bound(12, pictures.receivers.seen(), nearest),
                                           Bound(13, pictures.receivers.surfaces(), nearest),
                                           Bound(14, photons),
                                           Bound(15, account),
                                           Bound(16, buffers_.neighbours()),
                                           Bound(17, pictures.generators.depths(), nearest),
                                           Bound(18, pictures.receivers.depths(), nearest),
                                           Bound(19, cells),
                                           Bound(20, forks),
                                           Bound(21, interiors),
                                           Bound(22, *landings[0]),
                                           Bound(23, *landings[1]),
                                           Bound(24, tree_nodes),
                                           Bound(25, tree_triangles),
                                           Bound(26, standings)}));
    commands.pushConstants(push);
    if (lists) {
      commands.dispatchIndirect(cells, push.list * sizeof(CellListHead));
      return;
    }
    const std::uint32_t groups = gpu::groupsOf(settings.grid, kPixelGroup);
    commands.dispatch(groups, groups);
  });
}

}  // namespace nephroid
