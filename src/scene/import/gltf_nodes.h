// The node hierarchy: where everything is, and what of it belongs to the scene.
#pragma once

#include <vector>

#include "scene/import/accessor_reader.h"
#include "scene/import/gltf_animation.h"
#include "scene/scene_data.h"

namespace nephroid::gltf {

/// All nodes of the file.
struct NodeGraph {
  std::vector<mat4> world_from_node;  ///< one per node, finite
  std::vector<bool> in_scene;         ///< whether the node is to be shown
};

/// The nodes' own transforms, not animated yet. Rotations are normalised.
/// @throws InputError on projective matrices
std::vector<LocalTransform> readLocalTransforms(Document& document);

/// Multiplies the transforms down the hierarchy and finds the default scene's nodes: `scene`, else the first scene,
/// else everything (with a warning). A node that a scene lists without being a root keeps its parents' transforms and
/// is shown once. Works without recursion, so depth is no matter.
/// @throws InputError on nodes that do not exist, have two parents or are their own ancestors, and on non-finite
/// results
NodeGraph buildNodeGraph(Document& document, const std::vector<LocalTransform>& locals);

/// Places all meshes of the scene's nodes, EXT_mesh_gpu_instancing included. A node's primitives share `object`; each
/// instance of EXT_mesh_gpu_instancing is an object of its own. Instances without volume (a scale of zero hides things)
/// are left out with a warning.
///
/// Mirrored instances (determinant of world_from_object < 0) keep their mesh as it is: whoever transforms the triangles
/// swaps two corners of each, so that counter-clockwise triangles look outward in the world as well (glTF 2.0, section
/// 3.7.4).
void placeMeshes(Document& document, AccessorReader& reader, const NodeGraph& graph, SceneData& scene);

}  // namespace nephroid::gltf
