// What every importer does to a mesh before anyone renders it: no vertex that is not used, no value that is not a
// number.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scene/scene_data.h"

namespace nephroid {

/// Removes vertices that no triangle uses (files share one array among many primitives), keeping the order of the rest,
/// so that the bounds of the positions are those of the surface.
/// @param mesh  indices in range
void dropUnusedVertices(Mesh& mesh);

/// The first vertex whose position is NaN, infinite, or too large for products of lengths to stay finite.
std::optional<std::size_t> findNonFinitePosition(const Mesh& mesh);

/// How many values `repairAttributes` had to replace.
struct RepairCounts {
  std::size_t normals = 0, tangents = 0, texcoords = 0, colors = 0;
};

/// Makes normals and tangents unit (a normal without direction becomes that of its triangles; one bad tangent drops
/// all), non-finite texture coordinates and negative or non-finite colours 0.
/// @param mesh  positions finite, indices in range
RepairCounts repairAttributes(Mesh& mesh);

/// Area-weighted normals of the triangles around each vertex, unit; +Y where they cancel or there are none.
std::vector<vec3> computeVertexNormals(const Mesh& mesh);

/// Gives a mesh smooth normals: corners at the same position share one, weighted by the angle there, unless their
/// triangles' planes differ by more than `crease_angle` radians. Vertices that need two normals are duplicated.
/// Texture coordinates and colours are kept; tangents are dropped. Triangles without area take what their neighbours
/// have, or +Y.
void computeSmoothNormals(Mesh& mesh, float crease_angle);

}  // namespace nephroid
