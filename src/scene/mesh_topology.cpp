#include "scene/mesh_topology.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

namespace nephroid {
namespace {

/// For each vertex the first vertex (in sorted order) at exactly the same position; +0 and −0 are equal.
std::vector<std::uint32_t> weldPositions(const std::vector<vec3>& positions) {
  const auto key = [&](std::uint32_t i) {
    const vec3 p = positions[i] + vec3(0.0F);
    return std::array<std::uint32_t, 3>{std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
                                        std::bit_cast<std::uint32_t>(p.z)};
  };
  std::vector<std::uint32_t> order(positions.size()), first(positions.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, key);
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && key(order[i - 1]) == key(order[i]) ? first[order[i - 1]] : order[i];
  return first;
}

/// An undirected edge, and the sense in which a triangle runs along it.
struct Edge {
  std::uint32_t low, high;
  bool forward;
  std::uint32_t side;  ///< 3 · triangle + which of its edges
};

std::vector<Edge> collectEdges(const Mesh& mesh, const std::vector<std::uint32_t>& welded) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
    const uvec3 t = mesh.triangles[triangle];
    const std::array<std::uint32_t, 3> v{welded[t.x], welded[t.y], welded[t.z]};
    // A triangle that welding folds to a line has no sides; its two edges would only cancel.
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t from = v[i], to = v[(i + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), from < to, 3 * triangle + i});
    }
  }
  return edges;
}

void countEdges(std::vector<Edge> edges, MeshTopology& topology) {
  const auto key = [](const Edge& e) { return std::pair(e.low, e.high); };
  std::ranges::sort(edges, {}, key);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i, forward = 0;
    for (; j < edges.size() && key(edges[j]) == key(edges[i]); ++j) forward += edges[j].forward ? 1 : 0;
    const std::size_t count = j - i;
    if (count == 1) ++topology.open_edge_count;
    if (count > 2) ++topology.nonmanifold_edge_count;
    if (count == 2 && forward != 1) ++topology.inconsistent_edge_count;
    i = j;
  }
}

}  // namespace

std::vector<uvec3> findNeighbours(const Mesh& mesh) {
  std::vector<Edge> edges = collectEdges(mesh, weldPositions(mesh.positions));
  const auto key = [](const Edge& e) { return std::pair(e.low, e.high); };
  std::ranges::sort(edges, {}, key);
  std::vector<uvec3> neighbours(mesh.triangles.size(), uvec3(kNoNeighbour));
  for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
    for (j = i + 1; j < edges.size() && key(edges[j]) == key(edges[i]);) ++j;
    if (j - i != 2) continue;
    const std::uint32_t a = edges[i].side, b = edges[i + 1].side;
    neighbours[a / 3][static_cast<int>(a % 3)] = b / 3;
    neighbours[b / 3][static_cast<int>(b % 3)] = a / 3;
  }
  return neighbours;
}

MeshTopology analyseMesh(const Mesh& mesh) {
  MeshTopology topology;
  countEdges(collectEdges(mesh, weldPositions(mesh.positions)), topology);
  // About a point near the mesh: far from the origin the terms of the volume would cancel.
  const dvec3 centre = mesh.triangles.empty() ? dvec3(0) : dvec3(mesh.positions[mesh.triangles[0].x]);
  for (const uvec3& t : mesh.triangles) {
    const dvec3 a = dvec3(mesh.positions[t.x]) - centre, b = dvec3(mesh.positions[t.y]) - centre,
                c = dvec3(mesh.positions[t.z]) - centre;
    const dvec3 normal = glm::cross(b - a, c - a);
    if (!(glm::length(normal) > 0.0)) ++topology.degenerate_count;
    topology.volume += glm::dot(a, glm::cross(b, c)) / 6.0;
    if (mesh.normals.empty()) continue;
    const dvec3 shading = dvec3(mesh.normals[t.x]) + dvec3(mesh.normals[t.y]) + dvec3(mesh.normals[t.z]);
    if (glm::dot(shading, normal) < 0.0) ++topology.flipped_normal_count;
  }
  return topology;
}

double computeWindingNumber(const Mesh& mesh, dvec3 point) {
  double solid_angle = 0;
  for (const uvec3& t : mesh.triangles) {
    const dvec3 a = dvec3(mesh.positions[t.x]) - point, b = dvec3(mesh.positions[t.y]) - point,
                c = dvec3(mesh.positions[t.z]) - point;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double numerator = glm::dot(a, glm::cross(b, c));
    const double denominator = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    solid_angle += 2.0 * std::atan2(numerator, denominator);
  }
  return solid_angle / (4.0 * 3.14159265358979323846);
}

}  // namespace nephroid
