// glTF primitives become meshes.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "scene/import/accessor_reader.h"
#include "scene/scene_data.h"

namespace nephroid::gltf {

/// The triangle primitives of glTF mesh `mesh_index`, one Mesh each, ready to render: indices in range, normals unit,
/// positions finite, no vertex without a triangle. Points and lines are left out with a warning; strips and fans become
/// triangles. Primitives without triangles yield nothing.
/// @param material_of  glTF material index (−1: none) to index into SceneData::materials
/// @throws InputError
std::vector<Mesh> readMesh(Document& document, AccessorReader& reader, std::size_t mesh_index,
                           const std::function<std::uint32_t(int)>& material_of);

/// Triangles of a primitive in the given glTF mode, from its vertex indices in order. Strips alternate their winding so
/// that all triangles look the same way (glTF 2.0, section 3.7.2.1); what is left over is dropped.
/// @return empty for points and lines
std::vector<uvec3> assembleTriangles(int mode, const std::vector<std::uint32_t>& indices);

}  // namespace nephroid::gltf
