#include "frame/triangle_tree.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/math.h"
#include "frame/table.h"
#include "nephroid/error.h"

namespace nephroid {
namespace {

/// Triangles of a leaf: what is tested for one box.
constexpr std::size_t kMaxLeaf = 3;
constexpr int kBins = 16;
/// More triangles than this have one order only, for the sake of memory.
constexpr std::size_t kMaxOrdered = 400'000;
/// Widening of boxes, relative to the coordinates: the rounding of a shader's test.
constexpr float kBoxMargin = 1.0F / 1048576.0F;

struct Box {
  vec3 lower{kInfinity}, upper{-kInfinity};
  void add(vec3 p) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  void add(const Box& b) {
    lower = glm::min(lower, b.lower);
    upper = glm::max(upper, b.upper);
  }
  /// Half of its area: how likely a ray meets it.
  float extent() const {
    const vec3 d = upper - lower;
    return d.x < 0.0F ? 0.0F : d.x * d.y + d.y * d.z + d.z * d.x;
  }
};

struct Item {
  Box box;
  vec3 middle;
  std::uint32_t triangle;  ///< of all
};

/// A node of the tree while it is built.
struct Branch {
  Box box;
  std::uint32_t first = 0, count = 0;  ///< items; of a leaf
  std::uint32_t children[2] = {0, 0};
  int axis = -1;  ///< along which the first child lies before the second; −1: a leaf
};

class Builder {
 public:
  explicit Builder(std::vector<Item>& items) : items_(items) {}

  std::vector<Branch> build() {
    branches_.reserve(items_.size());
    if (!items_.empty()) add(0, items_.size());
    return std::move(branches_);
  }

 private:
  std::uint32_t add(std::size_t first, std::size_t end) {
    const auto index = static_cast<std::uint32_t>(branches_.size());
    branches_.emplace_back();
    Box box, middles;
    for (std::size_t i = first; i < end; ++i) box.add(items_[i].box), middles.add(items_[i].middle);
    branches_[index].box = box;
    const std::size_t count = end - first;
    if (count <= kMaxLeaf) {
      branches_[index].first = static_cast<std::uint32_t>(first);
      branches_[index].count = static_cast<std::uint32_t>(count);
      return index;
    }
    int axis = 0;
    const std::size_t middle = split(first, end, middles, axis);
    branches_[index].axis = axis;
    const std::uint32_t low = add(first, middle), high = add(middle, end);
    branches_[index].children[0] = low;
    branches_[index].children[1] = high;
    return index;
  }

  /// By bins along the longest axis ([wald-2007]): where the boxes of both sides, by the number in each, are least
  /// likely to be met; items are sorted by side.
  std::size_t split(std::size_t first, std::size_t end, const Box& middles, int& axis) {
    const vec3 size = middles.upper - middles.lower;
    axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = first + (end - first) / 2;
    const auto begin = items_.begin();
    const auto at = [&](std::size_t i) { return begin + static_cast<std::ptrdiff_t>(i); };
    const int k = axis;
    const auto halve = [&] {
      std::nth_element(at(first), at(half), at(end), [k](const Item& a, const Item& b) {
        return a.middle[k] != b.middle[k] ? a.middle[k] < b.middle[k] : a.triangle < b.triangle;
      });
      return half;
    };
    if (!(size[k] > 0.0F)) return halve();
    const auto binOf = [&](const Item& item) {
      return std::clamp(static_cast<int>((item.middle[k] - middles.lower[k]) / size[k] * kBins), 0, kBins - 1);
    };
    const int best = chooseBin(first, end, binOf);
    const auto cut = std::partition(at(first), at(end), [&](const Item& item) { return binOf(item) < best; });
    const auto place = static_cast<std::size_t>(cut - begin);
    return place == first || place == end ? halve() : place;
  }

  template <class BinOf>
  int chooseBin(std::size_t first, std::size_t end, const BinOf& binOf) const {
    std::array<Box, kBins> boxes;
    std::array<std::size_t, kBins> counts{};
    for (std::size_t i = first; i < end; ++i) {
      const auto bin = static_cast<std::size_t>(binOf(items_[i]));
      boxes[bin].add(items_[i].box);
      ++counts[bin];
    }
    // Cost of all bins from each on, then of all before it.
    std::array<float, kBins> behind{};
    Box box;
    std::size_t count = 0;
    for (std::size_t bin = kBins - 1; bin > 0; --bin) {
      box.add(boxes[bin]);
      count += counts[bin];
      behind[bin] = box.extent() * static_cast<float>(count);
    }
    box = Box();
    count = 0;
    int best = kBins / 2;
    float least = kInfinity;
    for (std::size_t bin = 1; bin < kBins; ++bin) {
      box.add(boxes[bin - 1]);
      count += counts[bin - 1];
      const float cost = box.extent() * static_cast<float>(count) + behind[bin];
      if (cost < least) least = cost, best = static_cast<int>(bin);
    }
    return best;
  }

  std::vector<Item>& items_;
  std::vector<Branch> branches_;
};

/// Writes the nodes in the order that rays of one octant of directions walk them. @return  how many
std::uint32_t writeOrder(const std::vector<Branch>& branches, std::uint32_t octant, std::vector<TreeNode>& nodes) {
  const std::size_t base = nodes.size();
  // Second entry: the node is done, and what follows is where a walk that misses it goes on.
  struct Task {
    std::uint32_t branch;
    std::size_t node;
    bool done;
  };
  std::vector<Task> tasks;
  if (!branches.empty()) tasks.push_back({0, 0, false});
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    if (task.done) {
      nodes[task.node].skip = static_cast<std::uint32_t>(nodes.size() - base);
      continue;
    }
    const Branch& b = branches[task.branch];
    const vec3 margin = kBoxMargin * glm::max(glm::abs(b.box.lower), glm::abs(b.box.upper));
    const bool leaf = b.axis < 0;
    nodes.push_back({b.box.lower - margin, 0, b.box.upper + margin, leaf ? b.first << 2U | b.count : kNowhere});
    tasks.push_back({task.branch, nodes.size() - 1, true});
    if (leaf) continue;
    const bool turned = (octant >> static_cast<unsigned>(b.axis) & 1U) != 0;
    tasks.push_back({b.children[turned ? 0 : 1], 0, false});
    tasks.push_back({b.children[turned ? 1 : 0], 0, false});
  }
  return static_cast<std::uint32_t>(nodes.size() - base);
}

}  // namespace

TreeTables buildTree(const SceneData& scene) {
  std::vector<TreeTriangle> all;
  std::vector<Item> items;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      vec3 p[3];
      for (int k = 0; k < 3; ++k)
        p[k] = transformPoint(instance.world_from_object, mesh.positions[mesh.triangles[t][k]]);
      Item item;
      for (const vec3& corner : p) item.box.add(corner);
      item.middle = 0.5F * (item.box.lower + item.box.upper);
      item.triangle = static_cast<std::uint32_t>(all.size());
      items.push_back(item);
      all.push_back({p[0], static_cast<std::uint32_t>(i), p[1], static_cast<std::uint32_t>(t), p[2], 0});
    }
  }
  if (all.size() >= 1U << 29U) throw ResourceError("the scene has too many triangles for one tree");
  const std::vector<Branch> branches = Builder(items).build();
  TreeTables tables;
  for (const Item& item : items) tables.triangles.push_back(all[item.triangle]);
  tables.order_count = all.size() <= kMaxOrdered ? 8 : 1;
  for (std::uint32_t octant = 0; octant < tables.order_count; ++octant)
    tables.node_count = writeOrder(branches, octant, tables.nodes);
  return tables;
}

TriangleTree::TriangleTree(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene) {
  const TreeTables tables = buildTree(scene);
  node_count_ = tables.node_count;
  order_count_ = tables.order_count;
  nodes_ = makeTable<TreeNode>(device, recorder, tables.nodes, "tree of triangles");
  triangles_ = makeTable<TreeTriangle>(device, recorder, tables.triangles, "triangles of the tree");
}

}  // namespace nephroid
