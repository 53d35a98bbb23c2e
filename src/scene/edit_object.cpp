#include "scene/edit.h"

#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>

#include "nephroid/error.h"
#include "scene/edit_text.h"

namespace nephroid {
namespace {

constexpr double kHuge = 1e9;  // bound of lengths in an edit: beyond it single precision is of no use

}  // namespace

void applyObjectEdit(SceneData& scene, std::string_view edit) {
  const auto [pattern, values] = splitEdit(edit, "--object");
  const ParamSet params = parseEditValues({{"translate", vec3(0), -kHuge, kHuge, "m", "shift", {}},
                                           {"rotate", vec3(0), -36000.0, 36000.0, "deg", "about X, then Y, then Z", {}},
                                           {"scale", 1.0F, 1e-9, kHuge, "", "factor", {}},
                                           {"cast", true, 0, 0, "", "whether it may cast caustics", {}}},
                                          "--object", edit, values);
  const vec3 turn = params.getVec3("rotate");
  bool found = false;
  for (Instance& instance : scene.instances) {
    if (!matchesGlob(pattern, instance.name)) continue;
    found = true;
    const vec3 origin(instance.world_from_object[3]);
    mat4 change = glm::translate(mat4(1.0F), origin + params.getVec3("translate"));
    change = glm::rotate(change, radians(turn.z), vec3(0, 0, 1));
    change = glm::rotate(change, radians(turn.y), vec3(0, 1, 0));
    change = glm::rotate(change, radians(turn.x), vec3(1, 0, 0));
    change = glm::scale(change, vec3(params.getFloat("scale")));
    instance.world_from_object = glm::translate(change, -origin) * instance.world_from_object;
    if (params.isSet("cast")) instance.casts = params.getBool("cast");
  }
  if (!found)
    throw UsageError(
        fmt::format("--object {}: nothing is named '{}'; objects: {}", edit, pattern, listNames(scene.instances)));
}

}  // namespace nephroid
