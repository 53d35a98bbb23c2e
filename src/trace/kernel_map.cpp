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
/// Half-axes of footprints, in radii of a disc: a fold has no width, and far from it a straight line is a poor guess.
constexpr float kNarrowest = 0.3F, kWidest = 2.0F;

/// Of a disc of the same area.
float radiusOf(const KernelPhoton& photon) { return 1.0F / std::sqrt(photon.inverse_axes); }

/// What spreads a photon. @param radius  of a disc, m  @param scale  of its footprint
KernelPhoton makeKernel(const GridPhoton& photon, float radius, float scale) {
  const float longest = length(photon.axes[0]), shortest = length(photon.axes[1]);
  float a = radius, b = radius;
  vec3 along;
  if (longest > 0.0F) {
    a = radius * std::clamp(scale * longest / radius, kNarrowest, kWidest);
    b = radius * std::clamp(scale * shortest / radius, kNarrowest, kWidest);
    along = photon.axes[0] / longest;
  } else {
    along = Frame::fromZ(photon.normal).x;
  }
  return {.position = photon.position,
          .across = {along / a, cross(photon.normal, along) / b},
          .normal = photon.normal,
          .thickness_squared = kKernelFlatness * kKernelFlatness * a * b,
          .inverse_axes = 1.0F / (a * b),
          .dir = photon.dir,
          .flux = photon.flux};
}

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

  /// Notes the buckets of all cells that a kernel may meet, each once: two cells may share one.
  void enter(std::uint32_t index, std::vector<Entry>& found) const {
    const KernelPhoton& photon = photons_[index];
    const auto begin = static_cast<std::ptrdiff_t>(found.size());
    visitCells(photon, [&](glm::ivec3 cell) {
      const std::uint32_t bucket = grid_.bucketOf(cell);
      const auto is_same = [&](const Entry& e) { return e.bucket == bucket; };
      if (std::none_of(found.begin() + begin, found.end(), is_same)) found.push_back({bucket, index});
    });
  }

  /// By columns along the axis that is nearest to the normal: in each, the plane passes few cells.
  template <class Visit>
  void visitCells(const KernelPhoton& photon, Visit&& visit) const {
    const vec3 along = glm::abs(photon.normal);
    const int k = along.x >= along.y && along.x >= along.z ? 0 : along.y >= along.z ? 1 : 2;
    const int u = (k + 1) % 3, v = (k + 2) % 3;
    const float half_cell = 0.5F / grid_.inverse_cell;
    const float thickness = kSlack * std::sqrt(photon.thickness_squared);
    vec3 squares(0.0F);  // of the half-axes, which are as long as one over `across`
    for (const vec3& a : photon.across) squares += a * a / (dot(a, a) * dot(a, a));
    const vec3 reach = kSlack * glm::sqrt(squares) + thickness * along;
    const glm::ivec3 first = grid_.cellAt(photon.position - reach), last = grid_.cellAt(photon.position + reach);
    const float rise = (half_cell * (along[u] + along[v]) + thickness) / along[k];
    vec2 half_extent;  // of a cell, in half-axes
    for (int i = 0; i < 2; ++i) {
      const vec3 a = glm::abs(photon.across[i]);
      half_extent[i] = half_cell * (a.x + a.y + a.z) + (kSlack - 1.0F);
    }
    glm::ivec3 cell;
    for (cell[v] = first[v]; cell[v] <= last[v]; ++cell[v])
      for (cell[u] = first[u]; cell[u] <= last[u]; ++cell[u]) {
        cell[k] = first[k];
        vec3 to_middle = grid_.middleOf(cell) - photon.position;
        const float height = -(photon.normal[u] * to_middle[u] + photon.normal[v] * to_middle[v]) / photon.normal[k];
        vec3 low = photon.position, high = photon.position;
        low[k] += height - rise, high[k] += height + rise;
        const int begin_k = std::max(grid_.cellAt(low)[k], first[k]), end_k = std::min(grid_.cellAt(high)[k], last[k]);
        for (cell[k] = begin_k; cell[k] <= end_k; ++cell[k]) {
          to_middle = grid_.middleOf(cell) - photon.position;
          const vec2 middle(dot(to_middle, photon.across[0]), dot(to_middle, photon.across[1]));
          const vec2 outside = glm::max(glm::abs(middle) - half_extent, vec2(0.0F));
          if (dot(outside, outside) <= 1.0F) visit(cell);
        }
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
    for (std::size_t i = c * kChunk; i < std::min((c + 1) * kChunk, photons.size()); ++i)
      photons_[i] = makeKernel(photons[i], scale * radii.at(photons[i].position), scale);
  });
  float widest = 0.0F;
  for (const KernelPhoton& photon : photons_) widest = std::max(widest, radiusOf(photon));
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
