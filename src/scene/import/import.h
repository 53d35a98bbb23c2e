// Importers, one file per format. All treat their input as hostile.
#pragma once

#include <filesystem>

#include "scene/scene_data.h"

namespace nephroid {

/// glTF 2.0, .gltf or .glb; node animation at `time` seconds.
/// @throws InputError
SceneData importGltf(const std::filesystem::path& path, float time);

/// The triangles of a PLY, OBJ, STL (Assimp) or glTF file, merged into one mesh in object space, material 0. Without
/// normals in the file, smooth ones are computed (welded by position, split at creases above 60°).
/// @throws InputError
Mesh importMesh(const std::filesystem::path& path);

}  // namespace nephroid
