#include "trace/kernel_radii.h"

#include <algorithm>
#include <array>

namespace nephroid {
namespace {

/// Photons that a cube may hold undivided, and that its part must hold to know better.
constexpr std::size_t kFull = 32, kFewest = 4;
constexpr int kMaxDepth = 24;

int octantOf(vec3 position, vec3 centre) {
  return (position.x >= centre.x ? 1 : 0) | (position.y >= centre.y ? 2 : 0) | (position.z >= centre.z ? 4 : 0);
}
vec3 centreOf(int octant, vec3 parent, float half_side) {
  return parent + half_side * vec3((octant & 1) ? 1 : -1, (octant & 2) ? 1 : -1, (octant & 4) ? 1 : -1);
}

}  // namespace

KernelRadii::KernelRadii(std::span<const GridPhoton> photons, float expected, float narrowest, float widest)
    : narrowest_(narrowest), widest_(widest) {
  Bounds bounds;
  std::vector<vec3> positions;
  for (const GridPhoton& photon : photons) {
    positions.push_back(photon.position);
    bounds.add(photon.position);
  }
  centre_ = bounds.centre();
  half_side_ = 0.5F * maxComponent(bounds.extent());
  nodes_.emplace_back();
  split(0, positions, centre_, half_side_, 0, expected, widest_);
}

void KernelRadii::split(std::uint32_t node, std::span<vec3> positions, vec3 centre, float half_side, int depth,
                        float expected, float radius_around) {
  if (positions.size() >= kFewest) {
    nodes_[node].radius = radiusOf(positions, expected);
  } else {
    // Too few to measure: as if they were spread over the cube's side, but never denser than in the cube around it.
    const float area = 4.0F * half_side * half_side;
    const float sparse = std::sqrt(expected * area / (kPi * static_cast<float>(positions.size() + 1)));
    nodes_[node].radius = std::clamp(sparse, radius_around, widest_);
  }
  if (positions.size() <= kFull || depth == kMaxDepth) return;
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].children = children;
  nodes_.resize(nodes_.size() + 8);
  auto begin = positions.begin();
  for (int octant = 0; octant < 8; ++octant) {
    const auto end = std::partition(begin, positions.end(), [&](vec3 p) { return octantOf(p, centre) == octant; });
    split(children + static_cast<std::uint32_t>(octant), {begin, end}, centreOf(octant, centre, 0.5F * half_side),
          0.5F * half_side, depth + 1, expected, nodes_[node].radius);
    begin = end;
  }
}

/// Of a patch of any shape that is evenly covered with points, the area follows from their covariance: for a square of
/// side a the variances are a²/12 along each side, and the sum of the products of two of the three is their product.
float KernelRadii::radiusOf(std::span<const vec3> positions, float expected) const {
  dvec3 mean(0.0), diagonal(0.0), mixed(0.0);
  for (const vec3 position : positions) mean += dvec3(position);
  const auto count = static_cast<double>(positions.size());
  mean /= count;
  for (const vec3 position : positions) {
    const dvec3 d = dvec3(position) - mean;
    diagonal += d * d;
    mixed += dvec3(d.y * d.z, d.z * d.x, d.x * d.y);
  }
  diagonal /= count - 1.0, mixed /= count - 1.0;
  const double products =
      diagonal.x * diagonal.y + diagonal.y * diagonal.z + diagonal.z * diagonal.x - dot(mixed, mixed);
  const double area = 12.0 * std::sqrt(std::max(products, 0.0));
  return std::clamp(static_cast<float>(std::sqrt(expected * area / (kPi * count))), narrowest_, widest_);
}

float KernelRadii::at(vec3 position) const {
  vec3 centre = centre_;
  float half_side = half_side_;
  std::uint32_t node = 0;
  while (nodes_[node].children != 0) {
    const int octant = octantOf(position, centre);
    half_side *= 0.5F;
    centre = centreOf(octant, centre, half_side);
    node = nodes_[node].children + static_cast<std::uint32_t>(octant);
  }
  return nodes_[node].radius;
}

}  // namespace nephroid
