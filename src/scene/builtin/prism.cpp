// A glass prism that spreads a slit of sunlight into a spectrum on the floor.
//
// The prism lies along Z. At turn 0 its apex points up and its base is level. Light that travels inside parallel to the
// base is deviated least, by δ with sin((A + δ)/2) = n sin(A/2); with the sun at elevation e on the left and the prism
// turned by e + δ/2 towards the floor, the light leaves downwards at e + δ. The default turn is that for n = 1.5, A =
// 60°.
#include <glm/gtc/matrix_transform.hpp>

#include <array>

#include "scene/builtin/scenes.h"
#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"
#include "scene/directions.h"

namespace nephroid {
namespace {

/// A dark plate in front of the prism, square to the sun, with a slit in it that runs along Z.
void addSlit(SceneData& scene, const ParamSet& params, vec3 prism_centre, float side, float reach) {
  const double half_slit = 0.5 * params.getFloat("slit"), half_long = 0.9 * params.getFloat("length");
  const dvec3 to_sun =
      glm::normalize(dvec3(directionTowards(params.getFloat("sun-azimuth"), params.getFloat("sun-elevation"))));
  const dvec3 centre = dvec3(prism_centre) + to_sun * (1.3 * side);
  dvec3 along = dvec3(0, 0, 1) - to_sun * to_sun.z;
  along = glm::length(along) > 1e-6 ? glm::normalize(along) : dvec3(1, 0, 0);
  const dvec3 across = glm::cross(to_sun, along);
  const double half_width = 0.5 * (reach - half_slit);
  for (const double sign : {-1.0, 1.0})
    addObject(scene,
              makeRectangle("slit plate", centre + across * (sign * (half_slit + half_width)), along * half_long,
                            across * half_width),
              makeDiffuse("slit plate", vec3(0)));
}

SceneData build(const ParamSet& params, float) {
  const float side = params.getFloat("side"), length = params.getFloat("length"), height = params.getFloat("height");
  const double half_apex = glm::radians(0.5 * static_cast<double>(params.getFloat("apex")));
  // Corners about the centroid: two sides of the given length meet at the apex.
  const double half_base = side * std::sin(half_apex), rise = side * std::cos(half_apex);
  const std::array<dvec2, 3> corners{{{-half_base, -rise / 3}, {half_base, -rise / 3}, {0, 2 * rise / 3}}};
  SceneData scene;
  addFloor(scene, params);
  const vec3 centre(0, height, 0);
  const mat4 world_from_prism =
      glm::rotate(glm::translate(mat4(1.0F), centre), -radians(params.getFloat("turn")), vec3(0, 0, 1));
  addObject(scene, makePrism("prism", corners, -0.5 * length, 0.5 * length, params.getInt("segments")),
            makeGlass(params, "prism"), world_from_prism);
  if (params.getFloat("slit") > 0.0F) addSlit(scene, params, centre, side, 1.2F * height);
  addLight(scene, params);
  addCamera(scene, vec3(1.3F, 1.5F, 2.6F) * height, vec3(0.2F, 0.5F, 0) * height, 42);
  return scene;
}

}  // namespace

BuiltinScene describePrismScene() {
  return {"prism", "A flint-glass prism that spreads a slit of sunlight into a spectrum", "Wyman et al., prism; Newton",
          [] {
            std::vector<ParamSpec> specs = joinParams(
                {lightParams({.sun_elevation_deg = 30,
                              .sun_azimuth_deg = -90,
                              .sun_angle_deg = 0,
                              .position = {-0.5F, 0.49F, 0},
                              .target = {0, 0.2F, 0}}),
                 {{"side", 0.04F, 1e-6, 1e5, "m", "side of the prism's section from apex to base", {}},
                  {"apex", 60.0F, 1.0, 170.0, "deg", "angle between the two faces that light crosses", {}},
                  {"length", 0.12F, 1e-6, 1e5, "m", "length of the prism along Z", {}},
                  {"height", 0.2F, 1e-6, 1e5, "m", "height of the prism's axis (its centroid) above the floor", {}},
                  {"turn", 48.6F, -360.0, 360.0, "deg", "turn about Z from apex up, clockwise seen from +Z", {}},
                  {"slit", 0.004F, 0.0, 1e5, "m", "width of the slit in front of the prism; 0: no slit", {}}},
                 glassParams(1.5F, vec3(1), 0.05F),
                 segmentParams(1, "pieces along the prism"),
                 floorParams(0.8F)});
            for (ParamSpec& spec : specs)
              if (spec.name == "abbe") spec.default_value = 30.0F;
            return specs;
          }(),
          &build};
}

}  // namespace nephroid
