// A balloon glass of cognac: two nested dielectrics and an amber absorber.
//
// The glass is one closed solid of revolution with a wall of constant thickness. The cognac is a closed solid of its
// own that reaches half way into that wall; the glass has the higher priority, so that light meets air–glass,
// glass–cognac and cognac–air and never two surfaces in one place.
#include <algorithm>

#include "nephroid/error.h"
#include "scene/builtin/scenes.h"
#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"

namespace nephroid {
namespace {

/// Outlines of a glass of unit height, foot at y = 0.
struct Outline {
  Bezier belly{{0, 0.30}, {0.17, 0.30}, {0.31, 0.40}, {0.31, 0.60}};    ///< inside, axis to widest
  Bezier mouth{{0.31, 0.60}, {0.31, 0.78}, {0.23, 0.92}, {0.21, 1.0}};  ///< inside, widest to rim
  double foot_radius = 0.26, foot_edge = 0.016, stem_radius = 0.035, stem_y = 0.17;
  double join = 0.32;  ///< where on the belly the stem begins
};

Bezier scaleCurve(Bezier curve, double scale) {
  return {curve.p0 * scale, curve.p1 * scale, curve.p2 * scale, curve.p3 * scale};
}

/// The outside of the glass below the bowl: foot and stem, up to `end` on the bowl, where the outline runs along
/// `tangent`.
void appendFootAndStem(std::vector<ProfilePoint>& profile, const Outline& outline, double scale, dvec2 end,
                       dvec2 tangent, int steps) {
  const double r = outline.foot_radius * scale, edge = outline.foot_edge * scale;
  const dvec2 stem(outline.stem_radius * scale, outline.stem_y * scale);
  // Circular arcs by cubics leave the circle by 0.03 %: this constant gives the best of them.
  constexpr double kArc = 0.5522847498;
  const double half = 0.5 * edge;
  appendLine(profile, {0, 0}, {r - half, 0});
  appendBezier(profile, {{r - half, 0}, {r - half * (1 - kArc), 0}, {r, half * (1 - kArc)}, {r, half}}, steps / 4);
  appendBezier(profile, {{r, half}, {r, half * (1 + kArc)}, {r - half * (1 - kArc), edge}, {r - half, edge}},
               steps / 4);
  appendBezier(profile, {{r - half, edge}, {0.35 * r, edge * 1.6}, {stem.x, 0.45 * stem.y}, stem}, steps);
  const dvec2 lean = glm::normalize(tangent) * (0.5 * glm::distance(stem, end));
  appendBezier(profile, {stem, {stem.x, stem.y + 0.6 * (end.y - stem.y)}, end - lean, end}, steps);
}

Mesh makeGlassMesh(const Outline& outline, double scale, double wall, int segments) {
  const int steps = std::max(segments / 8, 8);
  const Bezier belly = scaleCurve(outline.belly, scale), mouth = scaleCurve(outline.mouth, scale);
  std::vector<ProfilePoint> profile;
  appendFootAndStem(profile, outline, scale, belly.offsetAt(outline.join, wall).position, belly.tangentAt(outline.join),
                    steps);
  const auto outside = [wall](const Bezier& curve) {
    return [&curve, wall](double t) { return curve.offsetAt(t, wall); };
  };
  const auto inside = [](const Bezier& curve) {
    return [&curve](double t) {
      ProfilePoint point = curve.offsetAt(t, 0.0);
      point.normal = -point.normal;
      return point;
    };
  };
  appendCurve(profile, outside(belly), outline.join, 1.0, steps);
  appendCurve(profile, outside(mouth), 0.0, 1.0, steps);
  // A half circle over the rim, from the outside's normal round to its opposite.
  const ProfilePoint rim = mouth.offsetAt(1.0, 0.5 * wall);
  const dvec2 up(-rim.normal.y, rim.normal.x);
  appendCurve(
      profile,
      [&](double t) {
        const double angle = 3.14159265358979323846 * t;
        const dvec2 normal = std::cos(angle) * rim.normal + std::sin(angle) * up;
        return ProfilePoint{rim.position + 0.5 * wall * normal, normal, false};
      },
      0.0, 1.0, std::max(steps / 4, 4));
  appendCurve(profile, inside(mouth), 1.0, 0.0, steps);
  appendCurve(profile, inside(belly), 1.0, 0.0, steps);
  return makeRevolution("glass", profile, segments);
}

/// The curve parameter at which the offset curve reaches the height `y`; both rise with the parameter.
double findHeight(const Bezier& curve, double offset, double y) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (curve.offsetAt(middle, offset).position.y < y ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Mesh makeLiquidMesh(const Outline& outline, double scale, double wall, double fill, int segments) {
  const int steps = std::max(segments / 8, 8);
  const double overlap = 0.5 * wall;
  const Bezier belly = scaleCurve(outline.belly, scale), mouth = scaleCurve(outline.mouth, scale);
  const double level = belly.p0.y + fill * (mouth.p3.y - belly.p0.y);
  const auto wetted = [overlap](const Bezier& curve) {
    return [&curve, overlap](double t) { return curve.offsetAt(t, overlap); };
  };
  std::vector<ProfilePoint> profile;
  const bool above_belly = level > belly.p3.y;
  appendCurve(profile, wetted(belly), 0.0, above_belly ? 1.0 : findHeight(belly, overlap, level), steps);
  if (above_belly) appendCurve(profile, wetted(mouth), 0.0, findHeight(mouth, overlap, level), steps);
  const dvec2 edge = profile.back().position;
  appendLine(profile, edge, {0, edge.y});
  return makeRevolution("cognac", profile, segments);
}

SceneData build(const ParamSet& params, float) {
  const float height = params.getFloat("height"), wall = params.getFloat("wall");
  if (wall > 0.1F * height) throw UsageError("wall must be at most a tenth of height");
  const int segments = params.getInt("segments");
  const Outline outline;
  SceneData scene;
  addFloor(scene, params);

  Material glass;
  glass.name = "glass";
  glass.roughness = 0.0F;
  glass.transmission = 1.0F;
  glass.thickness = 1.0F;
  glass.ior = params.getFloat("glass-ior");
  glass.priority = 1;
  // A hair above the floor, as the rough foot of a real glass: its flat bottom must not coincide with the floor.
  mat4 lifted(1.0F);
  lifted[3].y = 0.002F * height;
  addObject(scene, makeGlassMesh(outline, height, wall, segments), glass, lifted);
  if (params.getFloat("fill") > 0.0F)
    addObject(scene, makeLiquidMesh(outline, height, wall, params.getFloat("fill"), segments),
              makeGlass(params, "cognac"), lifted);
  addLight(scene, params);
  addCamera(scene, vec3(0.3F, 1.7F, 2.9F) * height, vec3(-0.35F, 0.3F, -0.1F) * height, 34);
  return scene;
}

}  // namespace

BuiltinScene describeCognacScene() {
  return {"cognac", "A balloon glass of cognac on a table", "Larsen, cognac glass",
          joinParams({lightParams({.kind = "point",
                                   .sun_elevation_deg = 40,
                                   .sun_azimuth_deg = 75,
                                   .position = {0.4F, 0.38F, 0.1F},
                                   .target = {0, 0.06F, 0}}),
                      {{"height", 0.12F, 1e-6, 1e5, "m", "height of the glass", {}},
                       {"wall", 0.0015F, 1e-7, 1e4, "m", "thickness of the bowl's wall", {}},
                       {"glass-ior", 1.52F, 0.1, 10.0, "", "index of refraction of the glass", {}},
                       {"fill", 0.3F, 0.0, 0.95, "", "height of the cognac as a fraction of the bowl's; 0: empty", {}}},
                      glassParams(1.36F, {0.85F, 0.4F, 0.06F}, 0.04F),
                      segmentParams(256, "facets around the glass"),
                      floorParams(1.0F)}),
          &build};
}

}  // namespace nephroid
