#include "scene/edit.h"

#include <fmt/format.h>

#include <charconv>

#include "nephroid/error.h"
#include "scene/edit_text.h"

namespace nephroid {
namespace {

constexpr double kHuge = 1e9;  // bound of lengths in an edit: beyond it single precision is of no use

Camera parseCamera(const SceneData& scene, std::string_view choice) {
  const ParamSet p = parseEditValues({{"eye", vec3(0), -kHuge, kHuge, "m", "where the camera is", {}},
                                      {"target", vec3(0), -kHuge, kHuge, "m", "what it looks at", {}},
                                      {"fov", 40.0F, 0.01, 175.0, "deg", "vertical angle of view", {}},
                                      {"ortho", 0.0F, 1e-9, kHuge, "m", "height of an orthographic view", {}},
                                      {"up", vec3(0, 1, 0), -kHuge, kHuge, "", "what is up in the picture", {}}},
                                     "--camera", choice, choice, ':');
  if (!p.isSet("eye")) throw UsageError(fmt::format("--camera {}: eye=x,y,z is missing", choice));
  const Bounds bounds = scene.bounds();
  const vec3 eye = p.getVec3("eye");
  const vec3 target = p.isSet("target") ? p.getVec3("target") : bounds.empty() ? vec3(0) : bounds.centre();
  if (eye == target) throw UsageError(fmt::format("--camera {}: eye and target are the same point", choice));
  Camera camera = makeCamera("command line", eye, target, radians(p.getFloat("fov")),
                             p.isSet("ortho") ? p.getFloat("ortho") : 0.0F);
  if (p.isSet("up")) {
    const vec3 right = cross(camera.forward, p.getVec3("up"));
    if (!(length(right) > 1e-6F * length(p.getVec3("up"))))
      throw UsageError(fmt::format("--camera {}: up is along the line of sight", choice));
    camera.up = normalize(cross(right, camera.forward));
  }
  return camera;
}

}  // namespace

Camera selectCamera(const SceneData& scene, std::string_view choice) {
  for (const Camera& camera : scene.cameras)
    if (camera.name == choice) return camera;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(choice.data(), choice.data() + choice.size(), index);
  const bool is_index = error == std::errc() && end == choice.data() + choice.size();
  if (is_index && index < scene.cameras.size()) return scene.cameras[index];
  if (choice.find('=') != std::string_view::npos) return parseCamera(scene, choice);
  throw UsageError(fmt::format(
      "--camera {}: there is no such camera; cameras by index from 0: {}; or give eye=x,y,z:target=x,y,z:fov=DEG",
      choice, listNames(scene.cameras)));
}

}  // namespace nephroid
