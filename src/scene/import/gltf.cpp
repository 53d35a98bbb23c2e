// glTF 2.0 in the order of its parts: document, extensions, materials, nodes, meshes, lights, cameras.
#include <exception>
#include <new>

#include "nephroid/error.h"
#include "scene/import/gltf_document.h"
#include "scene/import/gltf_extensions.h"
#include "scene/import/gltf_materials.h"
#include "scene/import/gltf_nodes.h"
#include "scene/import/gltf_views.h"
#include "scene/import/import.h"

namespace nephroid {
namespace {

SceneData importChecked(const std::filesystem::path& path, float time) {
  gltf::Document document = gltf::loadDocument(path);
  gltf::checkExtensions(document);
  gltf::AccessorReader reader(document);
  SceneData scene;
  scene.name = cleanPath(path.filename());
  gltf::readMaterials(document, scene);
  std::vector<gltf::LocalTransform> locals = gltf::readLocalTransforms(document);
  scene.duration = gltf::animateNodes(document, reader, time, locals);
  const gltf::NodeGraph graph = gltf::buildNodeGraph(document, locals);
  gltf::placeMeshes(document, reader, graph, scene);
  gltf::readLights(document, graph, scene);
  gltf::readCameras(document, graph, scene);
  if (scene.materials.empty()) scene.materials.push_back(gltf::makeDefaultMaterial());
  if (scene.instances.empty()) document.warn("scene", "nothing to draw: no node shows triangles");
  scene.warnings = document.warnings.take();
  return scene;
}

}  // namespace

SceneData importGltf(const std::filesystem::path& path, float time) {
  try {
    return importChecked(path, time);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw ResourceError(cleanPath(path) + ": not enough memory to load it");
  } catch (const std::exception& error) {
    // tinygltf, Draco and the JSON library throw what they please on input that they did not foresee.
    throw InputError(cleanPath(path) + ": not a valid glTF file (" + cleanName(error.what()) + ")");
  }
}

}  // namespace nephroid
