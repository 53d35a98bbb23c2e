#include "frame/light_grids.h"

#include <algorithm>

#include "frame/passes.h"
#include "frame/table.h"
#include "frame/view.h"
#include "shaders/frame/light_grid.comp.h"

namespace nephroid {
namespace {

/// Of the heads of all lights together.
constexpr std::uint64_t kMaxHeadBytes = std::uint64_t{64} << 20;
/// Cells along a side of a view: enough for lists to be short, and what no scene needs more of.
constexpr std::uint32_t kMinGridSize = 32;

/// Lights that stay have so many times as many cells along a side as those that vary: their grids are made once, so
/// that only their memory counts against short lists.
constexpr std::uint32_t kFinerIfStaying = 2;

/// Pushed by light_grid.comp.
struct GridPush {
  std::uint32_t instance, triangle_count, light, first_head, first_view, view_count, view_mask, grid_size, first_node,
      node_capacity;
  vec3 scene_lower, scene_upper;
  vec4 source;
};

/// Heads of one light that has six views and stays.
std::uint64_t headsOf(std::uint32_t grid_size) {
  const std::uint64_t size = std::uint64_t{kFinerIfStaying} * grid_size, fine = 6 * size * size;
  // Coarse cells have a list and a mark each.
  return fine + 2 * (fine / (std::uint64_t{kCoarseCell} * kCoarseCell));
}

void setGrid(LightRecord& light, const std::vector<ViewRecord>& views, std::uint32_t size) {
  light.grid_size = size;
  if (views.size() != 1) return;
  const float half = 0.5F * static_cast<float>(size);
  light.grid_row_x = half * (views[0].clip_row_x + views[0].clip_row_w);
  light.grid_row_y = half * (views[0].clip_row_y + views[0].clip_row_w);
}

std::uint32_t chooseGridSize(std::uint32_t wanted, std::size_t lights) {
  std::uint32_t size = std::max(wanted / kCoarseCell * kCoarseCell, kCoarseCell);
  while (size > kMinGridSize && 4 * headsOf(size) * lights > kMaxHeadBytes) size = size / 2 / kCoarseCell * kCoarseCell;
  return size;
}

}  // namespace

LightGrids::LightGrids(gpu::Device& device, const SceneData& scene, const SceneBuffers& buffers,
                       std::uint32_t grid_size, std::uint32_t seed)
    : device_(device),
      buffers_(buffers),
      scene_(scene),
      seed_(seed),
      bounds_(scene.bounds()),
      light_views_(std::in_place, scene, seed),
      grid_size_(chooseGridSize(grid_size, light_views_->count())),
      pipeline_(device,
                {.shader = shaders::light_grid_comp,
                 .bindings = SceneBuffers::bindings({kTexels, kStoredTexels, kStoredTexels, kTable}),
                 .push_bytes = sizeof(GridPush),
                 .constants = buffers.traits().constants()},
                "light grid") {
  makeHeads();
  allocate();
}

void LightGrids::makeHeads() {
  const auto lights = static_cast<std::uint32_t>(std::max<std::size_t>(light_views_->count(), 1));
  heads_ = gpu::Buffer(device_, lights * headsOf(grid_size_) * sizeof(std::uint32_t),
                       VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT,
                       gpu::MemoryIntent::kDevice, "heads of lights' grids", VK_FORMAT_R32_UINT);
  counters_ = gpu::Buffer(device_, lights * sizeof(std::uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                          gpu::MemoryIntent::kDevice, "counters of lights' grids");
  // Small triangles lie in one cell or two of one view, thin ones in some dozens; if there are more, the first build
  // tells.
  std::uint32_t triangles = 0;
  for (const SceneBuffers::Draw& draw : buffers_.draws()) triangles += draw.index_count / 3;
  Light unbuilt;
  unbuilt.node_capacity = 2 * triangles + 32768;
  lights_.assign(light_views_->count(), unbuilt);
}

void LightGrids::geometryChanged() {
  bounds_ = scene_.bounds();
  light_views_.emplace(scene_, seed_);
  for (Light& light : lights_) light.built = false;
  if (light_views_->count() == lights_.size()) return;
  // A lamp that was scaled to nothing is one no more, and may come back.
  makeHeads();
  allocate();
}

void LightGrids::allocate() {
  std::uint64_t nodes = 0;
  for (Light& light : lights_) {
    light.first_node = static_cast<std::uint32_t>(nodes);
    nodes += light.node_capacity;
    light.built = false;
  }
  nodes_ = gpu::Buffer();
  nodes_ = makeWrittenTable(device_, nodes * (sizeof(GridNode) / 16), "nodes of lights' grids");
}

bool LightGrids::makeViews(std::uint32_t sample) {
  bool changed = false;
  std::uint32_t first_view = 0;
  for (std::uint32_t i = 0; i < lights_.size(); ++i) {
    Light& light = lights_[i];
    if (!light.built) {
      const std::optional<LightView> view = light_views_->make(i, sample);
      light.record = view ? view->light : LightRecord{};
      light.views = view ? view->views : std::vector<ViewRecord>{};
      light.varies = view ? view->varies : !light_views_->isOut(i);
      light.record.has_size = view && view->varies ? 1 : 0;
      light.record.first_head = static_cast<std::uint32_t>(i * headsOf(grid_size_));
      setGrid(light.record, light.views, light.varies ? grid_size_ : kFinerIfStaying * grid_size_);
      changed = true;
    }
    light.first_view = first_view;
    first_view += static_cast<std::uint32_t>(light.views.size());
  }
  return changed || !light_table_.valid();
}

void LightGrids::uploadTables(gpu::CommandRecorder& recorder) {
  std::vector<LightRecord> records;
  std::vector<ViewRecord> views;
  for (const Light& light : lights_) {
    records.push_back(light.record);
    views.insert(views.end(), light.views.begin(), light.views.end());
  }
  light_table_ = makeTable<LightRecord>(device_, recorder, records, "lights");
  lights_buffer_ =
      gpu::makeBuffer<LightRecord>(device_, recorder, records, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "lights");
  view_table_ = makeTable<ViewRecord>(device_, recorder, views, "views of lights");
}

void LightGrids::update(gpu::CommandRecorder& recorder, std::uint32_t sample, std::vector<gpu::PassTime>& times) {
  if (!makeViews(sample)) return;
  do {
    recorder.begin();
    uploadTables(recorder);
    for (std::uint32_t i = 0; i < lights_.size(); ++i)
      if (!lights_[i].built && !lights_[i].views.empty()) build(recorder, i);
    recorder.submit();
    recorder.wait();
    times.insert(times.end(), recorder.passTimes().begin(), recorder.passTimes().end());
  } while (!checkCapacity());
  for (Light& light : lights_) light.built = !light.varies;
}

void LightGrids::build(gpu::CommandRecorder& recorder, std::uint32_t index) {
  const Light& light = lights_[index];
  const vec4 source =
      light.record.kind == kLightDirectional ? vec4(-light.record.direction, 0.0F) : vec4(light.record.position, 1.0F);
  recorder.pass("clear grid", {Use(heads_, Access::kTransferWrite), Use(counters_, Access::kTransferWrite)},
                [&](PassCommands& commands) {
                  const VkDeviceSize bytes = headsOf(grid_size_) * sizeof(std::uint32_t);
                  commands.fill(heads_, kNowhere, index * bytes, bytes);
                  commands.fill(counters_, 0, index * sizeof(std::uint32_t), sizeof(std::uint32_t));
                });
  const std::vector<Use> uses =
      buffers_.uses(Access::kComputeRead, {Use(view_table_, Access::kComputeRead), Use(heads_, Access::kComputeWrite),
                                           Use(nodes_, Access::kComputeWrite), Use(counters_, Access::kComputeWrite)});
  recorder.pass("light grid", uses, [&](PassCommands& commands) {
    commands.bind(pipeline_);
    commands.bindResources(
        buffers_.bound({Bound(7, view_table_), Bound(8, heads_), Bound(9, nodes_), Bound(10, counters_)}));
    for (const SceneBuffers::Draw& draw : buffers_.draws()) {
      std::uint32_t view_mask = 0;
      for (std::size_t v = 0; v < light.views.size(); ++v)
        if (mayShow(light.views[v], draw.bounds)) view_mask |= 1U << v;
      if (view_mask == 0) continue;
      const std::uint32_t triangles = draw.index_count / 3;
      commands.pushConstants(GridPush{draw.instance, triangles, index, light.record.first_head, light.first_view,
                                      light.record.view_count, view_mask, light.record.grid_size, light.first_node,
                                      light.node_capacity, bounds_.lower, bounds_.upper, source});
      commands.dispatch(gpu::groupsOf(triangles, 64));
    }
  });
}

bool LightGrids::checkCapacity() {
  if (lights_.empty()) return true;
  const auto counts = gpu::readBackAs<std::uint32_t>(device_, counters_);
  bool enough = true;
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    Light& light = lights_[i];
    if (light.views.empty() || light.built || counts[i] <= light.node_capacity) continue;
    // As many again will do if the light stays, and nearly so many if it moves.
    light.node_capacity = counts[i] + (light.varies ? counts[i] / 4 : 0);
    enough = false;
  }
  if (!enough) allocate();
  return enough;
}

std::vector<gpu::Bound> LightGrids::bound(std::uint32_t first) const {
  return {{first, light_table_}, {first + 1, heads_}, {first + 2, nodes_}, {first + 3, lights_buffer_}};
}

std::vector<gpu::Use> LightGrids::uses() const {
  return {{light_table_, Access::kComputeRead},
          {heads_, Access::kComputeRead},
          {nodes_, Access::kComputeRead},
          {lights_buffer_, Access::kComputeRead}};
}

}  // namespace nephroid
