// Cameras and punctual lights: what glTF hangs on nodes besides meshes.
#pragma once

#include "scene/import/gltf_nodes.h"

namespace nephroid::gltf {

/// Appends the cameras of the scene's nodes, named after the node, else the camera. Cameras look along the node's −Z;
/// scale does not matter. An orthographic camera's height is 2·ymag.
/// @throws InputError
void readCameras(Document& document, const NodeGraph& graph, SceneData& scene);

/// Appends the lights of KHR_lights_punctual on the scene's nodes, named after the node, else the light. Spots and suns
/// shine along the node's −Z. Candela and lux are taken as W/sr and W/m² (DESIGN: Units). `extras.radius` (m) gives a
/// point or spot a size, `extras.angle` (degrees) a sun its angular diameter. `range` is not physical: ignored, warned.
/// @throws InputError
void readLights(Document& document, const NodeGraph& graph, SceneData& scene);

}  // namespace nephroid::gltf
