#include "scene/edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "nephroid/error.h"
#include "scene/directions.h"
#include "scene/edit_text.h"

namespace nephroid {
namespace {

constexpr double kHuge = 1e9;  // bound of lengths in an edit: beyond it single precision is of no use

std::vector<ParamSpec> lightSpecs() {
  return {
      {"position", vec3(0), -kHuge, kHuge, "m", "of a point or spot light", {}},
      {"direction", vec3(0, -1, 0), -kHuge, kHuge, "", "along which a sun or spot light shines", {}},
      {"azimuth", 0.0F, -360.0, 360.0, "deg", "where the light comes from: 0 is +Z, 90 is +X", {}},
      {"elevation", 45.0F, -90.0, 90.0, "deg", "height from where the light comes", {}},
      {"intensity", 1.0F, 0.0, 1e12, "W/sr", "of a point or spot light's strongest channel", {}},
      {"irradiance", 10.0F, 0.0, 1e12, "W/m^2", "of a sun's strongest channel, perpendicular to it", {}},
      {"color", vec3(1), 0.0, 1e6, "", "linear RGB, multiplies intensity or irradiance", {}},
      {"radius", 0.0F, 0.0, kHuge, "m", "of a point or spot light's bulb", {}},
      {"angle", 0.0F, 0.0, 90.0, "deg", "angular diameter of a sun", {}},
      {"inner", 0.0F, 0.0, 90.0, "deg", "half-angle of a spot's full intensity", {}},
      {"outer", 45.0F, 0.0, 90.0, "deg", "half-angle at which a spot ends", {}},
      {"off", false, 0, 0, "", "removes the light", {}},
  };
}

const char* kindName(LightKind kind) {
  return kind == LightKind::kSun ? "sun" : kind == LightKind::kSpot ? "spot" : "point";
}

/// Keys that mean nothing for this kind of light are slips: better said than ignored.
void checkLightKeys(const ParamSet& p, const Light& light, std::string_view edit) {
  const bool sun = light.kind == LightKind::kSun, spot = light.kind == LightKind::kSpot;
  const auto refuse = [&](const char* key, bool meaningful, const char* instead) {
    if (p.isSet(key) && !meaningful)
      throw UsageError(fmt::format("--light {}: a {} light has no {}{}", edit, kindName(light.kind), key, instead));
  };
  refuse("intensity", !sun, "; give irradiance");
  refuse("irradiance", sun, "; give intensity");
  refuse("position", !sun, "; give azimuth and elevation");
  refuse("radius", !sun, "; give angle");
  refuse("angle", sun, "; give radius");
  refuse("direction", sun || spot, "");
  refuse("azimuth", sun || spot, "; give position");
  refuse("elevation", sun || spot, "; give position");
  refuse("inner", spot, "");
  refuse("outer", spot, "");
  if (p.isSet("direction") && (p.isSet("azimuth") || p.isSet("elevation")))
    throw UsageError(fmt::format("--light {}: direction and azimuth/elevation contradict each other", edit));
  if (p.isSet("direction") && length(p.getVec3("direction")) == 0.0F)
    throw UsageError(fmt::format("--light {}: direction=0,0,0 points nowhere", edit));
}

void turnLight(Light& light, const ParamSet& p) {
  if (p.isSet("direction")) light.direction = normalize(p.getVec3("direction"));
  if (!p.isSet("azimuth") && !p.isSet("elevation")) return;
  const vec3 from = -light.direction;
  float azimuth = degrees(std::atan2(from.x, from.z)), elevation = degrees(std::asin(std::clamp(from.y, -1.0F, 1.0F)));
  if (p.isSet("azimuth")) azimuth = p.getFloat("azimuth");
  if (p.isSet("elevation")) elevation = p.getFloat("elevation");
  light.direction = -directionTowards(azimuth, elevation);
}

void editLight(Light& light, const ParamSet& p, std::string_view edit) {
  checkLightKeys(p, light, edit);
  turnLight(light, p);
  if (p.isSet("position")) light.position = p.getVec3("position");
  if (p.isSet("radius")) light.radius = p.getFloat("radius");
  if (p.isSet("angle")) light.angle_deg = p.getFloat("angle");
  if (p.isSet("inner")) light.inner_cone = radians(p.getFloat("inner"));
  if (p.isSet("outer")) light.outer_cone = radians(p.getFloat("outer"));
  if (p.isSet("outer") && !p.isSet("inner")) light.inner_cone = std::min(light.inner_cone, light.outer_cone);
  if (light.inner_cone > light.outer_cone)
    throw UsageError(fmt::format("--light {}: inner ({:g} deg) must not exceed outer ({:g} deg)", edit,
                                 degrees(light.inner_cone), degrees(light.outer_cone)));
  const float strongest = maxComponent(light.intensity);
  vec3 color = strongest > 0.0F ? light.intensity / strongest : vec3(1);
  float magnitude = strongest;
  if (p.isSet("intensity")) magnitude = p.getFloat("intensity");
  if (p.isSet("irradiance")) magnitude = p.getFloat("irradiance");
  if (p.isSet("color")) color = p.getVec3("color");
  light.intensity = color * magnitude;
}

/// A new light that shines on the scene from above, as bright there as the sun that a scene without lights gets.
Light makeLightFor(const SceneData& scene, LightKind kind) {
  constexpr float kIrradiance = 10.0F;
  const Bounds bounds = scene.bounds();
  const float radius = bounds.radius() > 0.0F ? bounds.radius() : 1.0F;
  const vec3 centre = bounds.empty() ? vec3(0) : bounds.centre();
  Light light;
  light.name = kindName(kind);
  light.kind = kind;
  light.intensity = vec3(kIrradiance);
  if (kind == LightKind::kSun) {
    light.direction = -directionTowards(0, 45);
    return light;
  }
  const float distance = 2.0F * radius;
  light.position = centre + vec3(0, distance, 0);
  light.intensity = vec3(kIrradiance * distance * distance);
  return light;
}

/// Turns a spot light that was only told where to stand.
void faceScene(Light& light, const SceneData& scene) {
  const vec3 towards = (scene.bounds().empty() ? vec3(0) : scene.bounds().centre()) - light.position;
  if (light.kind == LightKind::kSpot && length(towards) > 0.0F) light.direction = normalize(towards);
}

std::optional<LightKind> parseLightKind(std::string_view name) {
  for (const LightKind kind : {LightKind::kSun, LightKind::kPoint, LightKind::kSpot})
    if (name == kindName(kind)) return kind;
  return std::nullopt;
}

}  // namespace

void applyLightEdit(SceneData& scene, std::string_view edit) {
  auto [pattern, values] = splitEdit(edit, "--light");
  if (values == "off") values = "off=true";
  const ParamSet params = parseEditValues(lightSpecs(), "--light", edit, values);
  const auto matches = [&pattern = pattern](const Light& light) { return matchesGlob(pattern, light.name); };
  const bool found = std::ranges::any_of(scene.lights, matches);
  if (found && params.getBool("off")) {
    std::erase_if(scene.lights, matches);
    return;
  }
  if (!found) {
    const std::optional<LightKind> kind = parseLightKind(pattern);
    if (!kind || params.getBool("off"))
      throw UsageError(fmt::format("--light {}: there is no light '{}'; lights: {}{}", edit, pattern,
                                   listNames(scene.lights), kind ? "" : "; sun, point and spot would add one"));
    scene.lights.push_back(makeLightFor(scene, *kind));
    editLight(scene.lights.back(), params, edit);
    if (!params.isSet("direction") && !params.isSet("azimuth") && !params.isSet("elevation"))
      faceScene(scene.lights.back(), scene);
    return;
  }
  for (Light& light : scene.lights)
    if (matches(light)) editLight(light, params, edit);
}

}  // namespace nephroid
