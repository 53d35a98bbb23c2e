// What a triangle mesh is as a surface: closed or open, consistently wound or not, and which way it faces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/scene_data.h"

namespace nephroid {

/// Counts over one mesh in object space, vertices of equal position taken as one.
struct MeshTopology {
  std::size_t open_edge_count = 0;          ///< edges with one triangle
  std::size_t nonmanifold_edge_count = 0;   ///< with more than two
  std::size_t inconsistent_edge_count = 0;  ///< with two that run along it in the same sense
  std::size_t degenerate_count = 0;         ///< triangles without area
  std::size_t flipped_normal_count = 0;     ///< triangles whose vertex normals point against their winding
  double volume = 0;                        ///< signed, m³ of object space; positive if the winding faces outwards
  bool closed() const { return open_edge_count == 0 && nonmanifold_edge_count == 0; }
};

/// O(n log n) in the triangles; 16 bytes of scratch an edge.
MeshTopology analyseMesh(const Mesh& mesh);

/// Of each triangle those beyond its edges, from its first corner to the second, to the third, and back; kNoNeighbour
/// where the edge is open, or more than two triangles meet. Vertices of equal position are taken as one.
inline constexpr std::uint32_t kNoNeighbour = 0xFFFFFFFFU;
std::vector<uvec3> findNeighbours(const Mesh& mesh);

/// How often the surface of a closed mesh winds about `point` (object space): ±1 inside, 0 outside. O(n).
/// @see van Oosterom and Strackee 1983, the solid angle of a triangle
double computeWindingNumber(const Mesh& mesh, dvec3 point);

}  // namespace nephroid
