#include "frame/raster.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "frame/passes.h"
#include "frame/table.h"
#include "frame/view.h"
#include "shaders/frame/raster_parts.comp.h"
#include "shaders/frame/raster_seen.comp.h"
#include "shaders/frame/raster_split.comp.h"
#include "shaders/frame/raster_triangles.comp.h"

namespace nephroid {
namespace {

static_assert(sizeof(RasterPush) == 112);
static_assert(sizeof(RasterPart) == 16);

/// Threads of a group.
constexpr std::uint32_t kGroup = 64;
/// Threads of a group of raster_seen.comp.glsl lie in a row: nothing is done with a pixel but to fetch and to store,
/// and memory is fastest in the order in which it lies. So many pixels of two words are a line of a cache.
constexpr int kLinePixels = 8;
/// Groups that go through the list of parts, whose length only the device knows.
constexpr std::uint32_t kListGroups = 64;
/// Likewise, of lists that are nearly always empty.
constexpr std::uint32_t kFewGroups = 4;
/// Parts of large triangles that a frame has room for; what exceeds them is drawn by one thread a triangle.
constexpr std::uint32_t kPartCapacity = 1U << 17U;
/// Compute takes a mesh whose triangles have fewer pixels than this each, of the box about it. On lavapipe the
/// hardware's way costs 350 to 500 ns a triangle and 5 ns a pixel; this one, divided among cores, 110 and 60. It is to
/// be faster with two, and with fixed numbers the choice, and with it the picture, is the same for any count of cores.
constexpr float kPixelsPerTriangle = 8.0F;
/// With fewer triangles than this a draw's own dispatches cost more than is gained,
constexpr std::uint32_t kFewOfDraw = 256;
/// and with fewer in all the passes themselves: they take about 1 ms of a picture of 640 by 480.
constexpr std::uint32_t kFewInAll = 8192;
/// Of raster_triangles.comp.glsl.
constexpr std::uint32_t kPutsOffConstant = 5;

gpu::ComputePipeline makePass(gpu::Device& device, gpu::Spirv shader, const char* name,
                              std::initializer_list<VkDescriptorType> more = {},
                              std::vector<gpu::Constant> constants = {}) {
  std::vector<gpu::Binding> bindings = SceneBuffers::bindings({kTable, kTable, kTable, kTable});
  for (const VkDescriptorType type : more) bindings.push_back({static_cast<std::uint32_t>(bindings.size()), type});
  return {device,
          {.shader = shader, .bindings = bindings, .push_bytes = sizeof(RasterPush), .constants = std::move(constants)},
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

/// Where things inside of bounds are on the film, from its middle; `half` of it is as much as was said.
struct Outline {
  bool is_cut = false;  ///< some of it is before the near end: nothing else is known
  vec2 lower{kInfinity}, upper{-kInfinity};
  float least_w = kInfinity;
};

Outline outlineOf(const ViewRecord& view, const Bounds& bounds, vec2 half) {
  Outline outline;
  for (int corner = 0; corner < 8; ++corner) {
    const vec4 p((corner & 1) != 0 ? bounds.upper.x : bounds.lower.x,
                 (corner & 2) != 0 ? bounds.upper.y : bounds.lower.y,
                 (corner & 4) != 0 ? bounds.upper.z : bounds.lower.z, 1.0F);
    const float w = dot(view.clip_row_w, p);
    outline.is_cut = outline.is_cut || w <= dot(view.clip_row_z, p);
    const vec2 place = half / w * vec2(dot(view.clip_row_x, p), dot(view.clip_row_y, p));
    outline.lower = glm::min(outline.lower, place);
    outline.upper = glm::max(outline.upper, place);
    outline.least_w = std::min(outline.least_w, w);
  }
  return outline;
}

/// Share of the picture that bounds take up, in [0, 1].
float estimateShare(const ViewRecord& view, const Bounds& bounds) {
  const Outline outline = outlineOf(view, bounds, vec2(1.0F));
  if (outline.is_cut) return 1.0F;
  const vec2 extent =
      glm::clamp(outline.upper, vec2(-1.0F), vec2(1.0F)) - glm::clamp(outline.lower, vec2(-1.0F), vec2(1.0F));
  return 0.25F * extent.x * extent.y;
}

/// May a triangle of a draw be put off: is its box more than kPartPixels, or does it reach beyond the near end or far
/// off the film?
bool mayPutOff(const ViewRecord& view, const SceneBuffers::Draw& draw, vec2 half) {
  const Outline outline = outlineOf(view, draw.bounds, half);
  const vec2 farthest = glm::max(glm::abs(outline.lower), glm::abs(outline.upper));
  if (outline.is_cut || std::max(farthest.x, farthest.y) > 3.9F * std::max(half.x, half.y)) return true;
  // |x/w − x′/w′| ≤ (|x − x′| + |x′/w′| |w − w′|)/w.
  const vec2 per_metre = half * vec2(length(vec3(view.clip_row_x)), length(vec3(view.clip_row_y))) +
                         farthest * length(vec3(view.clip_row_w));
  const vec2 pixels = draw.longest_edge / outline.least_w * per_metre + 1.1F;
  return !(pixels.x * pixels.y <= static_cast<float>(kPartPixels));
}

/// Of all that draws may show.
PixelBox findPixels(const ViewRecord& view, std::span<const std::size_t> draws, const SceneBuffers& buffers,
                    glm::ivec2 size) {
  const vec2 half = 0.5F * vec2(size);
  vec2 lower(half), upper(-half);
  for (const std::size_t i : draws) {
    const Outline outline = outlineOf(view, buffers.draws()[i].bounds, half);
    lower = outline.is_cut ? -half : glm::min(lower, outline.lower);
    upper = outline.is_cut ? half : glm::max(upper, outline.upper);
  }
  // A pixel more for what triangles are widened by, and for rounding.
  const glm::ivec2 last(glm::ceil(glm::clamp(upper, -half, half) + half + 1.0F));
  glm::ivec2 first = glm::max(glm::ivec2(glm::floor(glm::clamp(lower, -half, half) + half - 2.0F)), glm::ivec2(0));
  first.x -= first.x % kLinePixels;
  return {first, glm::min(last, size - 1)};
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
  if (!device.hasInt64Atomics()) return Rasteriser::kHardware;
  // The hardware draws surfaces that may be passed after all others, against depths that it has drawn itself.
  if (buffers.traits().passable) return Rasteriser::kHardware;
  const VkPhysicalDeviceLimits& limits = device.limits();
  VkDeviceSize triangles = 0, most = 0;
  for (const SceneBuffers::Draw& draw : buffers.draws()) {
    triangles += draw.index_count / 3;
    most = std::max<VkDeviceSize>(most, draw.index_count / 3);
  }
  if (wanted == Rasteriser::kAuto && triangles < kFewInAll) return Rasteriser::kHardware;
  const VkDeviceSize pixels = static_cast<VkDeviceSize>(width) * static_cast<VkDeviceSize>(height);
  const bool fits = most <= VkDeviceSize{kGroup} * limits.maxComputeWorkGroupCount[0] &&
                    (kPartCapacity + triangles) * sizeof(RasterPart) <= limits.maxStorageBufferRange &&
                    8 * pixels <= limits.maxStorageBufferRange && pixels <= limits.maxTexelBufferElements &&
                    height < 65536;  // rows of a part have 16 bits
  return fits ? wanted : Rasteriser::kHardware;
}

ComputeRaster::ComputeRaster(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneBuffers& buffers,
                             int width, int height)
    : buffers_(buffers),
      width_(static_cast<std::uint32_t>(width)),
      height_(static_cast<std::uint32_t>(height)),
      split_(makePass(device, shaders::raster_split_comp, "raster split")),
      parts_(makePass(device, shaders::raster_parts_comp, "raster parts")),
      seen_pass_(makePass(device, shaders::raster_seen_comp, "raster seen", {kTexels, kTexture, kStorage, kTexels})) {
  for (std::uint32_t i = 0; i < 2; ++i)
    triangles_[i] = makePass(device, shaders::raster_triangles_comp, "raster triangles", {}, {{kPutsOffConstant, i}});
  std::uint32_t triangles = 0;
  std::vector<glm::uvec4> records;
  for (const SceneBuffers::Draw& draw : buffers.draws()) {
    first_numbers_.push_back(triangles);
    records.emplace_back(triangles, draw.instance, 0, 0);
    triangles += draw.index_count / 3;
  }
  draw_table_ = makeTable<glm::uvec4>(device, recorder, records, "draws of the raster");
  constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  constexpr gpu::MemoryIntent kDevice = gpu::MemoryIntent::kDevice;
  constexpr VkDeviceSize kWord = sizeof(std::uint32_t);
  keys_ =
      gpu::Buffer(device, VkDeviceSize{2} * width_ * height_ * kWord, kUsage | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
                  kDevice, "keys of the raster", VK_FORMAT_R32G32_UINT);
  counts_ = gpu::Buffer(device, (first_numbers_.size() + 1) * kCounts * kWord, kUsage, kDevice, "counts of the raster");
  // Behind the parts there is room for all triangles, should all be large.
  part_list_ = gpu::Buffer(device, (VkDeviceSize{kPartCapacity} + triangles) * sizeof(RasterPart), kUsage, kDevice,
                           "parts of the raster");
  items_ = gpu::Buffer(device, std::max(triangles, 1U) * kWord, kUsage, kDevice, "items of the raster");
}

void ComputeRaster::record(gpu::CommandRecorder& recorder, const ViewRecord& view,
                           const std::vector<std::size_t>& draws, const gpu::Image& seen, const gpu::Image& depth) {
  const glm::ivec2 size(static_cast<int>(width_), static_cast<int>(height_));
  const bool puts_off = std::ranges::any_of(
      draws, [&](std::size_t i) { return mayPutOff(view, buffers_.draws()[i], 0.5F * vec2(size)); });
  recordBegin(recorder, puts_off);
  RasterPush push = describeView(view, width_, height_);
  push.part_list = push.draw_count = static_cast<std::uint32_t>(first_numbers_.size());
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
    commands.pushConstants(push);
    commands.dispatch(groups);
  };
  const std::vector<Use> uses = buffers_.uses(Access::kComputeRead, {{keys_, Access::kComputeWrite},
                                                                     {counts_, Access::kComputeWrite},
                                                                     {part_list_, Access::kComputeWrite},
                                                                     {items_, Access::kComputeWrite}});
  const auto pass = [&](const char* name, const gpu::Pipeline& pipeline, const auto& dispatch, std::uint32_t groups) {
    recorder.pass(name, uses, [&](PassCommands& commands) {
      commands.bind(pipeline);
      commands.bindResources(bound({}));
      dispatch(commands, groups);
    });
  };
  pass("raster triangles", triangles_[puts_off ? 1 : 0], dispatchDraws, ~0U);
  if (puts_off) {
    pass("raster split", split_, dispatchDraws, kFewGroups);
    pass("raster parts", parts_, dispatchParts, kListGroups);
  }
  recordSeen(recorder, push, findPixels(view, draws, buffers_, size), seen, depth);
}

void ComputeRaster::recordBegin(gpu::CommandRecorder& recorder, bool puts_off) {
  if (has_begun_ && !puts_off) return;
  recorder.pass("raster begin", {Use(keys_, Access::kTransferWrite), Use(counts_, Access::kTransferWrite)},
                [&](PassCommands& commands) {
                  // Each picture leaves no keys behind.
                  if (!has_begun_) commands.fill(keys_, 0);
                  commands.fill(counts_, 0);
                });
  has_begun_ = true;
}

std::vector<Bound> ComputeRaster::bound(std::span<const Bound> more) const {
  std::vector<Bound> all = buffers_.bound({{7, keys_}, {8, counts_}, {9, part_list_}, {10, items_}});
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

void ComputeRaster::recordSeen(gpu::CommandRecorder& recorder, RasterPush push, const PixelBox& box,
                               const gpu::Image& seen, const gpu::Image& depth) {
  const glm::ivec2 extent = box.last - box.first + 1;
  if (extent.x <= 0 || extent.y <= 0) return;
  push.first_x = box.first.x;
  push.first_y = box.first.y;
  const std::vector<Use> uses = buffers_.uses(Access::kComputeRead, {{keys_, Access::kComputeWrite},
                                                                     {counts_, Access::kComputeWrite},
                                                                     {part_list_, Access::kComputeWrite},
                                                                     {items_, Access::kComputeWrite},
                                                                     {draw_table_, Access::kComputeRead},
                                                                     {depth, Access::kComputeRead},
                                                                     {seen, Access::kComputeWrite}});
  const std::array<Bound, 4> more{Bound(11, keys_), Bound(12, depth, buffers_.sampler()), Bound(13, seen),
                                  Bound(14, draw_table_)};
  recorder.pass("raster seen", uses, [&](PassCommands& commands) {
    commands.bind(seen_pass_);
    commands.bindResources(bound(more));
    commands.pushConstants(push);
    commands.dispatch(gpu::groupsOf(static_cast<std::uint32_t>(extent.x), kGroup),
                      static_cast<std::uint32_t>(extent.y));
  });
}

}  // namespace nephroid
