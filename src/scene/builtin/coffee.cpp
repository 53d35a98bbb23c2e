// A cup of milky coffee: light reflected by the inside of the wall draws the nephroid (a sun) or the cardioid (a lamp
// on the rim) on the surface. Seen from above, a ray off a vertical wall turns as in a plane circle, whatever its
// slope.
#include "nephroid/error.h"
#include "scene/builtin/scenes.h"
#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"

namespace nephroid {
namespace {

/// The mug with its foot at y = 0: straight walls, square edges.
Mesh makeMug(double inner, double wall, double height, int segments) {
  const double outer = inner + wall;
  std::vector<ProfilePoint> profile;
  appendLine(profile, {0, 0}, {outer, 0});
  appendLine(profile, {outer, 0}, {outer, height});
  appendLine(profile, {outer, height}, {inner, height});
  appendLine(profile, {inner, height}, {inner, wall});
  appendLine(profile, {inner, wall}, {0, wall});
  return makeRevolution("mug", profile, segments);
}

Material makeMugMaterial(const ParamSet& params) {
  if (params.getString("material") == "metal") return makeMirror("mug", params.getVec3("color"));
  Material ceramic = makeDiffuse("mug", params.isSet("color") ? params.getVec3("color") : vec3(0.8F, 0.79F, 0.75F));
  ceramic.specular_factor = 1.0F;
  ceramic.roughness = params.getFloat("roughness");
  ceramic.ior = params.getFloat("ior");
  return ceramic;
}

SceneData build(const ParamSet& params, float) {
  const double inner = params.getFloat("radius"), wall = params.getFloat("wall"), height = params.getFloat("height");
  const double level = height - params.getFloat("depth");
  if (level <= 1.01 * wall) throw UsageError("depth leaves no coffee in the mug; make it smaller or height larger");
  const int segments = params.getInt("segments");
  SceneData scene;
  addFloor(scene, params);
  // Stands a hair above the floor: its flat foot must not coincide with it.
  mat4 lifted(1.0F);
  lifted[3].y = static_cast<float>(0.002 * height);
  addObject(scene, makeMug(inner, wall, height, segments), makeMugMaterial(params), lifted);
  // The coffee ends inside the wall.
  addObject(scene, makeDisc("coffee", {0, level, 0}, inner + 0.5 * wall, segments),
            makeDiffuse("coffee", params.getVec3("coffee-color")), lifted);
  if (params.getBool("handle")) {
    constexpr double kReach = 1.2;  // rad, half of the arc; its ends lie in the wall
    const double arc = 0.3 * height, rod = 0.45 * wall;
    addObject(scene,
              makeBentRod("handle", {inner + 0.5 * wall - arc * std::cos(kReach), 0.5 * height, 0}, arc, rod, -kReach,
                          kReach, segments),
              makeDiffuse("handle", vec3(0.6F)), lifted);
  }
  addLight(scene, params);
  const auto radius = static_cast<float>(inner), top = static_cast<float>(level);
  addCamera(scene, vec3(0, top + 5.0F * radius, 3.2F * radius), vec3(0, top, 0), 34);
  return scene;
}

}  // namespace

BuiltinScene describeCoffeeScene() {
  return {"coffee", "A cup of milky coffee: the nephroid on its surface",
          "closed form: Bernoulli's and Huygens' caustics of the circle",
          joinParams(
              {lightParams({.sun_elevation_deg = 40,
                            .sun_azimuth_deg = 15,
                            .position = {0, 0.1F, 0.0399F},
                            .target = {0, 0.07F, 0}}),
               {{"radius", 0.04F, 1e-6, 1e5, "m", "inner radius of the mug", {}},
                {"height", 0.09F, 1e-6, 1e5, "m", "height of the mug", {}},
                {"wall", 0.004F, 1e-7, 1e5, "m", "thickness of the mug's wall and bottom", {}},
                {"depth", 0.02F, 1e-7, 1e5, "m", "from the rim down to the coffee", {}},
                {"handle", true, 0, 0, "", "with a handle at +X", {}},
                {"material", std::string("metal"), 0, 0, "", "polished metal or glazed ceramic", {"metal", "ceramic"}},
                {"color",
                 vec3(0.9F, 0.89F, 0.87F),
                 0.0,
                 1.0,
                 "",
                 "linear RGB: reflectance of metal, albedo of ceramic",
                 {}},
                {"ior", 1.5F, 1.0, 10.0, "", "index of refraction of the ceramic's glaze", {}},
                {"roughness", 0.1F, 0.0, 1.0, "", "roughness of the ceramic's glaze", {}},
                {"coffee-color", vec3(0.62F, 0.46F, 0.32F), 0.0, 1.0, "", "linear RGB albedo of the coffee", {}}},
               segmentParams(512, "facets around the mug"),
               floorParams(0.5F)}),
          &build};
}

}  // namespace nephroid
