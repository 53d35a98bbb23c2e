// Any mesh from a file in the setting of `sphere`.
#include <glm/gtc/matrix_transform.hpp>

#include "nephroid/error.h"
#include "scene/builtin/scenes.h"
#include "scene/builtin/setting.h"
#include "scene/import/import.h"

namespace nephroid {
namespace {

/// Scales the mesh's longest side to `size` and stands it on y = `lift`, centred, turned about the vertical.
mat4 placeMesh(const Bounds& bounds, float size, float lift, float turn_deg) {
  const vec3 centre = bounds.centre();
  mat4 world = glm::translate(mat4(1.0F), vec3(0, lift, 0));
  world = glm::rotate(world, radians(turn_deg), vec3(0, 1, 0));
  world = glm::scale(world, vec3(size / maxComponent(bounds.extent())));
  return glm::translate(world, -vec3(centre.x, bounds.lower.y, centre.z));
}

SceneData build(const ParamSet& params, float) {
  const std::string& file = params.getString("mesh");
  if (file.empty()) throw UsageError("mesh is missing; give it as builtin:object?mesh=FILE (PLY, OBJ, STL or glTF)");
  Mesh mesh = importMesh(file);
  mesh.name = "object";
  const Bounds bounds = mesh.bounds();
  if (bounds.empty() || !(maxComponent(bounds.extent()) > 0.0F))
    throw InputError(file + ": the mesh has no extent; a mesh with triangles is needed");
  const float size = 2.0F * params.getFloat("radius");
  SceneData scene;
  addFloor(scene, params);
  const mat4 world = placeMesh(bounds, size, params.getFloat("height"), params.getFloat("turn"));
  addObject(scene, std::move(mesh), makeCaster(params, "object", "glass"), world);
  addLight(scene, params);
  addCamera(scene, vec3(0, 1.8F, 3.2F) * size, vec3(-0.25F, 0.25F, 0) * size, 36);
  return scene;
}

}  // namespace

BuiltinScene describeObjectScene() {
  return {"object", "A mesh from a file in the setting of sphere (the Stanford bunny, say)",
          "Wyman et al., bunny; Shah et al. Fig. 9",
          joinParams({{{"mesh", std::string(), 0, 0, "", "PLY, OBJ, STL or glTF file", {}}},
                      lightParams({.kind = "point",
                                   .sun_elevation_deg = 55,
                                   .sun_azimuth_deg = 70,
                                   .position = {0.2F, 0.3F, 0.06F},
                                   .target = {0, 0.05F, 0}}),
                      {{"radius", 0.05F, 1e-6, 1e5, "m", "half of the longest side that the mesh is scaled to", {}},
                       {"height", 0.0005F, 0.0, 1e5, "m", "gap between the mesh and the floor", {}},
                       {"turn", 0.0F, -360.0, 360.0, "deg", "turn of the mesh about the vertical", {}}},
                      casterParams("glass", 1.5F, vec3(1), 0.1F),
                      floorParams(0.6F)}),
          &build};
}

}  // namespace nephroid
