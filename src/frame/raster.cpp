#include "frame/raster.h"

#include <algorithm>
#include <cmath>

#include "frame/passes.h"
#include "frame/raster.shared.h"
#include "frame/view.h"
#include "shaders/frame/raster_parts.comp.h"
#include "shaders/frame/raster_seen.comp.h"
#include "shaders/frame/raster_split.comp.h"
#include "shaders/frame/raster_triangles.comp.h"

namespace nephroid {
namespace {

static_assert(sizeof(RasterPush) == 104);
static_assert(sizeof(RasterPart) == 16);

/// Threads of a group.
constexpr std::uint32_t kGroup = 64;
/// Groups that go through lists whose length only the device knows.
constexpr std::uint32_t kListGroups = 64;
/// Likewise, of lists that are nearly always empty.
constexpr std::uint32_t kFewGroups = 4;
/// Parts of large triangles that a frame has room for; what exceeds them is drawn by one thread a triangle.
constexpr std::uint32_t kPartCapacity = 1U << 17U;
/// Compute takes a mesh whose triangles have fewer pixels than this each, of the box about it. On lavapipe the
/// hardware's way costs 350 to 500 ns a triangle and 5 ns a pixel; this one, divided among cores, 260 and 20. It is to
/// be faster with two, and with fixed numbers the choice, and with it the picture, is the same for any count of cores.
constexpr float kPixelsPerTriangle = 10.0F;
/// With fewer triangles than this a draw's own dispatches cost more than is gained,
constexpr std::uint32_t kFewOfDraw = 256;
/// and with fewer in all the passes themselves: they take 2 to 3 ms of a picture of 640 by 480.
constexpr std::uint32_t kFewInAll = 24576;

gpu::ComputePipeline makePass(gpu::Device& device, gpu::Spirv shader, const char* name,
                              std::vector<gpu::Constant> constants = {}) {
  return {device,
          {.shader = shader,
           .bindings = SceneBuffers::bindings({kTable, kTable, kTable, kTable, kTable, kTable, kTable}),
           .push_bytes = sizeof(RasterPush),
           .constants = std::move(constants)},
          name};
}

RasterPush describeView(const ViewRecord& view, std::uint32_t width, std::uint32_t height) {
  const vec2 half = 0.5F * vec2(static_cast<float>(width), static_cast<float>(height));
  const vec4 x = half.x * view.clip_row_x, y = half.y * view.clip_row_y, z = view.clip_row_z, w = view.clip_row_w;
  return {.clip_column_x = vec4(x.x, y.x, z.x, w.x),
          .clip_column_y = vec4(x.y, y.y, z.y, w.y),
          .clip_column_z = vec4(x.z, y.z, z.z, w.z),
          .clip_column_w = vec4(x.w, y.w, z.w, w.w),
          .size_x = static_cast<int>(width),
          .size_y = static_cast<int>(height),
          // Beyond that coordinates have too few digits left for fractions of a pixel.
          .guard = 4.0F * std::max(half.x, half.y),
          .part_capacity = kPartCapacity};
}

/// Share of the picture that bounds take up, in [0, 1].
float estimateShare(const ViewRecord& view, const Bounds& bounds) {
  vec2 lower(1.0F), upper(-1.0F);
  for (int corner = 0; corner < 8; ++corner) {
    const vec4 p((corner & 1) != 0 ? bounds.upper.x : bounds.lower.x,
                 (corner & 2) != 0 ? bounds.upper.y : bounds.lower.y,
                 (corner & 4) != 0 ? bounds.upper.z : bounds.lower.z, 1.0F);
    const float w = dot(view.clip_row_w, p);
    if (w <= dot(view.clip_row_z, p)) return 1.0F;
    const vec2 place(dot(view.clip_row_x, p) / w, dot(view.clip_row_y, p) / w);
    lower = glm::min(lower, place);
    upper = glm::max(upper, place);
  }
  const vec2 extent = glm::clamp(upper, vec2(-1.0F), vec2(1.0F)) - glm::clamp(lower, vec2(-1.0F), vec2(1.0F));
  return 0.25F * extent.x * extent.y;
}

}  // namespace

DrawSplit splitDraws(const ViewRecord& view, const std::vector<SceneBuffers::Draw>& draws, std::uint32_t pixel_count,
                     Rasteriser rasteriser) {
  DrawSplit split;
  std::vector<std::size_t> shown;
  std::uint32_t computed = 0;
  const auto isFine = [&](const SceneBuffers::Draw& draw) {
    const std::uint32_t triangles = draw.index_count / 3;
    const float pixels = estimateShare(view, draw.bounds) * static_cast<float>(pixel_count);
    return triangles >= kFewOfDraw && pixels < kPixelsPerTriangle * static_cast<float>(triangles);
  };
  for (std::size_t i = 0; i < draws.size(); ++i) {
    if (!mayShow(view, draws[i].bounds)) continue;
    if (draws[i].passable) {
      split.passable.push_back(i);
      continue;
    }
    shown.push_back(i);
    const bool compute = rasteriser == Rasteriser::kCompute || (rasteriser == Rasteriser::kAuto && isFine(draws[i]));
    (compute ? split.compute : split.hardware).push_back(i);
    if (compute) computed += draws[i].index_count / 3;
  }
  if (rasteriser == Rasteriser::kAuto && computed < kFewInAll) {
    split.hardware = std::move(shown);
    split.compute.clear();
  }
  return split;
}

Rasteriser chooseRasteriser(Rasteriser wanted, const gpu::Device& device, const SceneBuffers& buffers, int width,
                            int height) {
  if (wanted == Rasteriser::kAuto && !device.isCpu()) return Rasteriser::kHardware;
  // The hardware draws surfaces that may be passed after all others, against depths that it has drawn itself.
  if (buffers.traits().passable) return Rasteriser::kHardware;
  const VkPhysicalDeviceLimits& limits = device.limits();
  VkDeviceSize triangles = 0, most = 0;
  for (const SceneBuffers::Draw& draw : buffers.draws()) {
    triangles += draw.index_count / 3;
    most = std::max<VkDeviceSize>(most, draw.index_count / 3);
  }
  if (wanted == Rasteriser::kAuto && triangles < kFewInAll) return Rasteriser::kHardware;
  const bool fits = most <= VkDeviceSize{kGroup} * limits.maxComputeWorkGroupCount[0] &&
                    (kPartCapacity + triangles) * sizeof(RasterPart) <= limits.maxStorageBufferRange &&
                    VkDeviceSize{8} * static_cast<VkDeviceSize>(width) * static_cast<VkDeviceSize>(height) <=
                        limits.maxStorageBufferRange &&
                    height < 65536;  // rows of a part have 16 bits
  return fits ? wanted : Rasteriser::kHardware;
}

ComputeRaster::ComputeRaster(gpu::Device& device, const SceneBuffers& buffers, int width, int height)
    : buffers_(buffers),
      width_(static_cast<std::uint32_t>(width)),
      height_(static_cast<std::uint32_t>(height)),
      triangles_(makePass(device, shaders::raster_triangles_comp, "raster triangles")),
      split_(makePass(device, shaders::raster_split_comp, "raster split")),
      parts_(makePass(device, shaders::raster_parts_comp, "raster parts")) {
  for (std::uint32_t i = 0; i < 4; ++i)
    seen_passes_[i] = makePass(device, shaders::raster_seen_comp, "raster seen", {{5, i & 1U}, {6, i >> 1U}});
  std::uint32_t triangles = 0;
  for (const SceneBuffers::Draw& draw : buffers.draws()) {
    first_numbers_.push_back(triangles);
    triangles += draw.index_count / 3;
  }
  first_numbers_.push_back(triangles);
  constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  constexpr gpu::MemoryIntent kDevice = gpu::MemoryIntent::kDevice;
  const VkDeviceSize pixels = VkDeviceSize{width_} * height_, word = sizeof(std::uint32_t);
  // Behind the parts there is room for all triangles, should all be large.
  const VkDeviceSize parts = VkDeviceSize{kPartCapacity} + triangles;
  depths_ = gpu::Buffer(device, pixels * word, kUsage, kDevice, "depths of the raster");
  numbers_ = gpu::Buffer(device, pixels * word, kUsage, kDevice, "numbers of the raster");
  seen_ = gpu::Buffer(device, pixels * 2 * word, kUsage, kDevice, "seen by the raster");
  counts_ = gpu::Buffer(device, first_numbers_.size() * kCounts * word, kUsage, kDevice, "counts of the raster");
  part_list_ = gpu::Buffer(device, parts * sizeof(RasterPart), kUsage, kDevice, "parts of the raster");
  items_ = gpu::Buffer(device, (triangles + parts + triangles) * word, kUsage, kDevice, "items of the raster");
  overtaking_ = gpu::Buffer(device, (triangles + parts) * word, kUsage, kDevice, "overtaking of the raster");
}

void ComputeRaster::record(gpu::CommandRecorder& recorder, const ViewRecord& view,
                           const std::vector<std::size_t>& draws, const gpu::Image& seen, const gpu::Image& depth) {
  recorder.pass(
      "raster begin",
      {Use(depth, Access::kTransferRead), Use(seen, Access::kTransferRead), Use(depths_, Access::kTransferWrite),
       Use(seen_, Access::kTransferWrite), Use(numbers_, Access::kTransferWrite), Use(counts_, Access::kTransferWrite)},
      [&](PassCommands& commands) {
        commands.copy(depth, depths_);
        commands.copy(seen, seen_);
        commands.fill(numbers_, kNoNumber);
        commands.fill(counts_, 0);
      });
  RasterPush push = describeView(view, width_, height_);
  const std::uint32_t triangle_count = first_numbers_.back();
  push.first_put_off = triangle_count + kPartCapacity + triangle_count;
  push.part_list = static_cast<std::uint32_t>(buffers_.draws().size());
  const auto dispatchDraws = [&](PassCommands& commands, std::uint32_t most_groups) {
    for (const std::size_t i : draws) {
      const SceneBuffers::Draw& draw = buffers_.draws()[i];
      push.instance = draw.instance;
      push.triangle_count = draw.index_count / 3;
      push.list = static_cast<std::uint32_t>(i);
      push.first_number = first_numbers_[i];
      commands.pushConstants(push);
      commands.dispatch(std::min(gpu::groupsOf(push.triangle_count, kGroup), most_groups));
    }
  };
  const auto dispatchParts = [&](PassCommands& commands, std::uint32_t groups) {
    push.list = push.part_list;
    push.first_number = triangle_count;
    commands.pushConstants(push);
    commands.dispatch(groups);
  };
  const std::vector<Use> uses = buffers_.uses(Access::kComputeRead, {{depths_, Access::kComputeWrite},
                                                                     {counts_, Access::kComputeWrite},
                                                                     {part_list_, Access::kComputeWrite},
                                                                     {items_, Access::kComputeWrite},
                                                                     {overtaking_, Access::kComputeWrite},
                                                                     {numbers_, Access::kComputeWrite},
                                                                     {seen_, Access::kComputeWrite}});
  const std::vector<Bound> bound = buffers_.bound(
      {{7, depths_}, {8, counts_}, {9, part_list_}, {10, items_}, {11, overtaking_}, {12, numbers_}, {13, seen_}});
  const auto pass = [&](const char* name, const gpu::Pipeline& pipeline, const auto& dispatch, std::uint32_t groups) {
    recorder.pass(name, uses, [&](PassCommands& commands) {
      commands.bind(pipeline);
      commands.bindResources(bound);
      dispatch(commands, groups);
    });
  };
  pass("raster triangles", triangles_, dispatchDraws, ~0U);
  pass("raster split", split_, dispatchDraws, kFewGroups);
  pass("raster parts", parts_, dispatchParts, kListGroups);
  pass("raster seen", seen_passes_[0], dispatchDraws, kListGroups);
  pass("raster seen parts", seen_passes_[1], dispatchParts, kListGroups);
  pass("raster ties", seen_passes_[2], dispatchDraws, kFewGroups);
  pass("raster ties of parts", seen_passes_[3], dispatchParts, kFewGroups);
  recorder.pass("raster end", {Use(seen_, Access::kTransferRead), Use(seen, Access::kTransferWrite)},
                [&](PassCommands& commands) { commands.copy(seen_, seen); });
}

}  // namespace nephroid
