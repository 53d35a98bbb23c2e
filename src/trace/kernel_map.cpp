#include "trace/kernel_map.h"

#include <bit>
#include <utility>

#include "core/parallel.h"

namespace nephroid {
namespace {

/// Kernels of one task.
constexpr std::size_t kChunk = 4096;
/// Grids at most: a place looks into each.
constexpr std::size_t kMostGrids = 8;
/// For rounding: a cell that a disc only just misses may be entered, one that it meets must be.
constexpr float kSlack = 1.001F;

float radiusOf(const KernelPhoton& photon) { return 1.0F / std::sqrt(photon.inverse_squared_radius); }

}  // namespace

/// Finds the cells that discs meet, and puts them in order.
class KernelMap::GridBuilder {
 public:
  explicit GridBuilder(std::span<const KernelPhoton> photons) : photons_(photons) {}

  /// @param members  photons of the grid  @param cell  width of its cells, m
  Grid build(std::span<const std::uint32_t> members, float cell) {
    grid_ = {.inverse_cell = 1.0F / cell};
    // A disc as wide as two cells meets about a dozen.
    grid_.mask = std::bit_ceil(static_cast<std::uint32_t>(4 * members.size())) - 1;
    std::vector<std::vector<Entry>> found((members.size() + kChunk - 1) / kChunk);
    parallelFor(found.size(), [&](std::size_t c) {
      for (const std::uint32_t photon : members.subspan(c * kChunk, std::min(kChunk, members.size() - c * kChunk)))
        enter(photon, found[c]);
    });
    sort(found);
    return std::move(grid_);
  }

 private:
  struct Entry {
    std::uint32_t bucket, photon;
  };

  /// Notes the buckets of all cells that a disc may meet, each once: two cells may share one.
  void enter(std::uint32_t index, std::vector<Entry>& found) const {
    const KernelPhoton& photon = photons_[index];
    const float radius = kSlack * radiusOf(photon), thickness = kKernelFlatness * radius;
    const vec3 along = glm::abs(photon.normal);
    const vec3 reach = radius * glm::sqrt(glm::max(1.0F - along * along, vec3(0.0F))) + thickness * along;
    const float half_cell = 0.5F / grid_.inverse_cell;
    const float touch = thickness + half_cell * (along.x + along.y + along.z);
    const glm::ivec3 first = grid_.cellAt(photon.position - reach), last = grid_.cellAt(photon.position + reach);
    const auto begin = static_cast<std::ptrdiff_t>(found.size());
    glm::ivec3 cell;
    for (cell.z = first.z; cell.z <= last.z; ++cell.z)
      for (cell.y = first.y; cell.y <= last.y; ++cell.y)
        for (cell.x = first.x; cell.x <= last.x; ++cell.x) {
          const vec3 to_middle = grid_.middleOf(cell) - photon.position;
          const vec3 outside = glm::max(glm::abs(to_middle) - half_cell, vec3(0.0F));
          if (dot(outside, outside) > radius * radius || std::abs(dot(photon.normal, to_middle)) > touch) continue;
          const std::uint32_t bucket = grid_.bucketOf(cell);
          const auto is_same = [&](const Entry& e) { return e.bucket == bucket; };
          if (std::none_of(found.begin() + begin, found.end(), is_same)) found.push_back({bucket, index});
        }
  }

  /// By bucket, and within each in the order of the photons.
  void sort(std::span<const std::vector<Entry>> found) {
    grid_.begin.assign(std::size_t{grid_.mask} + 2, 0);
    for (const std::vector<Entry>& chunk : found)
      for (const Entry& e : chunk) ++grid_.begin[e.bucket + 1];
    for (std::size_t b = 0; b <= grid_.mask; ++b) grid_.begin[b + 1] += grid_.begin[b];
    std::vector<std::uint32_t> next(grid_.begin.begin(), grid_.begin.end() - 1);
    grid_.entries.resize(grid_.begin.back());
    for (const std::vector<Entry>& chunk : found)
      for (const Entry& e : chunk) grid_.entries[next[e.bucket]++] = e.photon;
  }

  std::span<const KernelPhoton> photons_;
  Grid grid_;
};

KernelMap::KernelMap(std::span<const GridPhoton> photons, const KernelRadii& radii, float scale) {
  if (photons.empty()) return;
  photons_.resize(photons.size());
  parallelFor((photons.size() + kChunk - 1) / kChunk, [&](std::size_t c) {
    for (std::size_t i = c * kChunk; i < std::min((c + 1) * kChunk, photons.size()); ++i) {
      const float radius = scale * radii.at(photons[i].position);
      photons_[i] = {photons[i], 1.0F / (radius * radius)};
    }
  });
  const float widest = scale * radii.widest();
  std::vector<std::vector<std::uint32_t>> levels(kMostGrids);
  for (std::uint32_t i = 0; i < photons_.size(); ++i) {
    const float halvings = std::max(std::floor(std::log2(widest / radiusOf(photons_[i]))), 0.0F);
    levels[std::min(static_cast<std::size_t>(halvings), kMostGrids - 1)].push_back(i);
  }
  GridBuilder builder(photons_);
  for (std::size_t level = 0; level < kMostGrids; ++level)
    if (!levels[level].empty())
      grids_.push_back(builder.build(levels[level], std::ldexp(widest, -static_cast<int>(level))));
}

}  // namespace nephroid
