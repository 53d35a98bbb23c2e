#include "trace/kernel_map.h"

#include <utility>

#include "core/parallel.h"
#include "trace/morton_order.h"

namespace nephroid {
namespace {

/// Grids at most: a place looks into each.
constexpr std::size_t kMostGrids = 8;
/// Cells of a grid, in radii of a disc like its largest ellipse.
constexpr float kCellWidth = 3.0F;
/// Kernels of one task.
constexpr std::size_t kChunk = 4096;
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
          .inverse_axes = 1.0F / (a * b),
          .dir = photon.dir,
          .flux = photon.flux};
}

/// Numbers of photons in the order in which they are kept: those of one place have few lines of the cache between them.
std::vector<std::uint32_t> orderByPlace(std::span<const GridPhoton> photons) {
  Bounds bounds;
  for (const GridPhoton& photon : photons) bounds.add(photon.position);
  const MortonOrder order(bounds);
  std::vector<std::uint32_t> keys(photons.size());
  std::ranges::transform(photons, keys.begin(), [&](const GridPhoton& photon) { return order.keyOf(photon.position); });
  return MortonOrder::sort(keys);
}

}  // namespace

/// Finds the cells that ellipses meet.
class KernelMap::GridBuilder {
 public:
  /// @param cell  width of cells, m
  GridBuilder(std::span<const KernelPhoton> photons, std::span<const std::uint32_t> members, float cell)
      : photons_(photons), members_(members), half_cell_(0.5F * cell), grid_(cell, members.size()) {}

  BoxGrid build() {
    std::vector<std::vector<BoxGrid::Entry>> entries((members_.size() + kChunk - 1) / kChunk);
    parallelFor(entries.size(), [&](std::size_t c) {
      for (const std::uint32_t photon : members_.subspan(c * kChunk, std::min(kChunk, members_.size() - c * kChunk)))
        enter(photon, entries[c]);
    });
    grid_.close(entries);
    return std::move(grid_);
  }

 private:
  /// By columns along the axis that is nearest to the normal: in each, the plane passes few cells.
  void enter(std::uint32_t index, std::vector<BoxGrid::Entry>& entries) const {
    const KernelPhoton& photon = photons_[index];
    const vec3 normal = photon.scaledNormal() / photon.inverse_axes, along = glm::abs(normal);
    const int k = along.x >= along.y && along.x >= along.z ? 0 : along.y >= along.z ? 1 : 2;
    const int u = (k + 1) % 3, v = (k + 2) % 3;
    const float thickness = kSlack * std::sqrt(photon.squaredThickness());
    vec3 squares(0.0F);  // of the half-axes, which are as long as one over `across`
    for (const vec3& a : photon.across) squares += a * a / (dot(a, a) * dot(a, a));
    const vec3 reach = kSlack * glm::sqrt(squares) + thickness * along;
    BoxGrid::Box box(grid_, index, photon.position - reach, photon.position + reach, entries);
    const glm::ivec3 first = grid_.cellAt(photon.position - reach), last = grid_.cellAt(photon.position + reach);
    const float rise = (half_cell_ * (along[u] + along[v]) + thickness) / along[k];
    vec2 half_extent;  // of a cell, in half-axes
    for (int i = 0; i < 2; ++i) {
      const vec3 a = glm::abs(photon.across[i]);
      half_extent[i] = half_cell_ * (a.x + a.y + a.z) + (kSlack - 1.0F);
    }
    glm::ivec3 cell;
    for (cell[v] = first[v]; cell[v] <= last[v]; ++cell[v])
      for (cell[u] = first[u]; cell[u] <= last[u]; ++cell[u]) {
        cell[k] = first[k];
        vec3 to_middle = grid_.middleOf(cell) - photon.position;
        const float height = -(normal[u] * to_middle[u] + normal[v] * to_middle[v]) / normal[k];
        vec3 low = photon.position, high = photon.position;
        low[k] += height - rise, high[k] += height + rise;
        const int begin_k = std::max(grid_.cellAt(low)[k], first[k]), end_k = std::min(grid_.cellAt(high)[k], last[k]);
        for (cell[k] = begin_k; cell[k] <= end_k; ++cell[k]) {
          to_middle = grid_.middleOf(cell) - photon.position;
          const vec2 middle(dot(to_middle, photon.across[0]), dot(to_middle, photon.across[1]));
          const vec2 outside = glm::max(glm::abs(middle) - half_extent, vec2(0.0F));
          if (dot(outside, outside) <= 1.0F) box.enter(cell);
        }
      }
  }

  std::span<const KernelPhoton> photons_;
  std::span<const std::uint32_t> members_;
  float half_cell_;  ///< m
  BoxGrid grid_;
};

KernelMap::KernelMap(std::span<const GridPhoton> photons, const KernelRadii& radii, float scale) {
  if (photons.empty()) return;
  photons_.resize(photons.size());
  const std::vector<std::uint32_t> order = orderByPlace(photons);
  parallelFor((photons.size() + kChunk - 1) / kChunk, [&](std::size_t c) {
    for (std::size_t i = c * kChunk; i < std::min((c + 1) * kChunk, photons.size()); ++i) {
      const GridPhoton& photon = photons[order[i]];
      photons_[i] = makeKernel(photon, scale * radii.at(photon.position), scale);
    }
  });
  float widest = 0.0F;
  for (const KernelPhoton& photon : photons_) widest = std::max(widest, radiusOf(photon));
  std::vector<std::vector<std::uint32_t>> levels(kMostGrids);
  for (std::uint32_t i = 0; i < photons_.size(); ++i) {
    const float halvings = std::max(std::floor(std::log2(widest / radiusOf(photons_[i]))), 0.0F);
    levels[std::min(static_cast<std::size_t>(halvings), kMostGrids - 1)].push_back(i);
  }
  for (std::size_t level = 0; level < kMostGrids; ++level)
    if (!levels[level].empty())
      grids_.push_back(
          GridBuilder(photons_, levels[level], std::ldexp(kCellWidth * widest, -static_cast<int>(level))).build());
}

}  // namespace nephroid
