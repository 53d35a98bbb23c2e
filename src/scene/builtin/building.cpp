// A concave mirror of a building on rolling ground: the sun's reflection burns a caustic into the square before it.
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

#include "scene/builtin/hash.h"
#include "scene/builtin/scenes.h"
#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"
#include "scene/builtin/water.h"

#include "nephroid/error.h"

namespace nephroid {
namespace {

constexpr double kTau = 6.283185307179586476925;

/// An arc about (0, curvature) in the (x, z) plane from left to right, seen from its hollow side at +z.
/// @param toward_hollow the normals' side
std::vector<CurvePoint> makeArc(double curvature, double radius, double half_angle, int steps, bool toward_hollow) {
  std::vector<CurvePoint> curve;
  for (int i = 0; i <= steps; ++i) {
    const double angle = half_angle * (2.0 * i / steps - 1.0);
    const dvec2 out(std::sin(angle), -std::cos(angle));
    curve.push_back({dvec2(0, curvature) + radius * out, toward_hollow ? -out : out});
  }
  return curve;
}

/// The straight back of the building behind the points of `front`.
std::vector<CurvePoint> makeBack(const std::vector<CurvePoint>& front, double z) {
  std::vector<CurvePoint> curve;
  curve.reserve(front.size());
  for (const CurvePoint& point : front) curve.push_back({{point.position.x, z}, {0, -1}});
  return curve;
}

Material makeFacade(const ParamSet& params) {
  if (params.getString("material") == "metal") return makeMirror("facade", params.getVec3("color"));
  // Panes before dark rooms: only the Fresnel reflection returns.
  Material material;
  material.name = "facade";
  material.base_color = vec4(0.02F, 0.02F, 0.02F, 1.0F);
  material.roughness = 0.0F;
  material.ior = params.getFloat("ior");
  return material;
}

/// Facade and body as two solids that overlap by half the facade's thickness.
void addBuilding(SceneData& scene, const ParamSet& params, double foot) {
  const double width = params.getFloat("width"), height = params.getFloat("height"),
               radius = params.getFloat("curvature");
  const double thickness = 0.02 * width, depth = 0.5 * width;
  const double half_angle = std::asin(0.5 * width / radius);
  const int steps = params.getInt("segments");
  const std::vector<CurvePoint> front = makeArc(radius, radius, half_angle, steps, true);
  const std::vector<CurvePoint> rear = makeArc(radius, radius + thickness, half_angle, steps, false);
  addObject(scene, makeCurvedWall("facade", front, rear, foot, height), makeFacade(params));
  const std::vector<CurvePoint> inside = makeArc(radius, radius + 0.5 * thickness, 0.99 * half_angle, steps, true);
  addObject(scene, makeCurvedWall("body", inside, makeBack(inside, -depth), foot, height - thickness),
            makeDiffuse("body", vec3(0.45F, 0.44F, 0.42F)));
}

/// Long hills, level before the building: their height grows with the distance from the square.
HeightSample sampleGround(const std::vector<PlaneWave>& hills, double level_radius, double x, double z) {
  const HeightSample raw = evaluateWaves(hills, x, z);
  const double s = (x * x + z * z) / (level_radius * level_radius);
  const double weight = s / (1.0 + s), dweight_ds = 1.0 / ((1.0 + s) * (1.0 + s));
  const double ds_dx = 2 * x / (level_radius * level_radius), ds_dz = 2 * z / (level_radius * level_radius);
  return {raw.y * weight, raw.dy_dx * weight + raw.y * dweight_ds * ds_dx,
          raw.dy_dz * weight + raw.y * dweight_ds * ds_dz};
}

SceneData build(const ParamSet& params, float) {
  const float width = params.getFloat("width"), height = params.getFloat("height"), relief = params.getFloat("relief");
  if (params.getFloat("curvature") < 0.51F * width)
    throw UsageError("curvature must be at least 0.51 of width, or the facade would be more than a half circle");
  const float size = params.getFloat("floor-size");
  std::vector<PlaneWave> hills;
  for (int i = 0; i < 6; ++i) {
    const double factor = std::pow(0.75, i);
    hills.push_back({0.4 * relief * factor, 0.6 * size * factor, kTau * hashToUnit(params.getInt("seed"), i, 0),
                     kTau * hashToUnit(params.getInt("seed"), i, 1)});
  }
  SceneData scene;
  addObject(scene,
            makeHeightField("terrain", size, size, 200, 200,
                            [&](double x, double z) { return sampleGround(hills, 1.5 * width, x, z); }),
            makeDiffuse("terrain", params.getVec3("floor-color")));
  addBuilding(scene, params, -1.2 * relief - 0.1 * height);
  addLight(scene, params);
  addCamera(scene, vec3(1.0F, 1.6F, 3.0F) * width, vec3(0, 0.28F, 0.3F) * width, 40);
  return scene;
}

}  // namespace

BuiltinScene describeBuildingScene() {
  return {"building", "A building with a hollow mirror front on rolling ground in the sun",
          "Wyman et al., building on terrain",
          joinParams(
              {lightParams(
                   {.sun_elevation_deg = 40, .sun_azimuth_deg = 15, .position = {40, 80, 100}, .target = {0, 10, 0}}),
               {{"width", 40.0F, 1e-6, 1e5, "m", "width of the front", {}},
                {"height", 35.0F, 1e-6, 1e5, "m", "height of the building", {}},
                {"curvature", 60.0F, 1e-6, 1e6, "m", "radius of the hollow front; light gathers at half of it", {}},
                {"relief", 4.0F, 0.0, 1e4, "m", "height of the hills around", {}},
                {"seed", 3, 0.0, 1e9, "", "chooses the hills", {}},
                {"material",
                 std::string("metal"),
                 0,
                 0,
                 "",
                 "front of metal, or of panes before dark rooms",
                 {"metal", "glass"}},
                {"ior", 1.5F, 1.0, 10.0, "", "index of refraction of the panes", {}},
                {"color", vec3(0.85F, 0.87F, 0.9F), 0.0, 1.0, "", "linear RGB reflectance of a metal front", {}}},
               segmentParams(128, "facets along the front"),
               {{"floor-size", 240.0F, 1e-6, 1e6, "m", "side of the square terrain", {}},
                {"floor-color", vec3(0.55F, 0.56F, 0.48F), 0.0, 1.0, "", "linear RGB albedo of the terrain", {}}}}),
          &build};
}

}  // namespace nephroid
