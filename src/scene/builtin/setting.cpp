#include "scene/builtin/setting.h"

#include <algorithm>
#include <cmath>

#include "nephroid/error.h"
#include "scene/builtin/shapes.h"
#include "scene/directions.h"
#include "scene/sky.h"

namespace nephroid {
namespace {

/// Rounded to two significant digits: a default that people can read.
float roundToTwoDigits(float value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return static_cast<float>(std::round(value / unit) * unit);
}

constexpr float kDefaultIrradiance = 10.0F;
constexpr double kLongest = 1e6;  // m; keeps a slip of the keyboard from making a scene that floats cannot hold

/// A square that shines towards the target, and to one side only.
void addAreaLight(SceneData& scene, const ParamSet& params) {
  const vec3 position = params.getVec3("light-position");
  const vec3 dir = normalize(params.getVec3("light-target") - position);
  const float width = params.getFloat("light-width");
  const Frame frame = Frame::fromZ(dir);
  Material material = makeDiffuse("light", vec3(0));
  // A small square of radiance L and area A has the intensity L A along its normal.
  material.emission = params.getVec3("light-color") * params.getFloat("intensity") / (width * width);
  addObject(scene, makeRectangle("light", position, dvec3(frame.x) * (0.5 * width), dvec3(frame.y) * (0.5 * width)),
            material);
}

void addPunctualLight(SceneData& scene, const ParamSet& params, LightKind kind) {
  Light light;
  light.name = params.getString("light");
  light.kind = kind;
  const vec3 color = params.getVec3("light-color");
  if (kind == LightKind::kSun) {
    light.direction = -directionTowards(params.getFloat("sun-azimuth"), params.getFloat("sun-elevation"));
    light.intensity = color * params.getFloat("irradiance");
    light.angle_deg = params.getFloat("sun-angle");
  } else {
    light.position = params.getVec3("light-position");
    light.direction = normalize(params.getVec3("light-target") - light.position);
    light.intensity = color * params.getFloat("intensity");
    light.radius = params.getFloat("light-radius");
  }
  if (kind == LightKind::kSpot) {
    light.outer_cone = radians(0.5F * params.getFloat("spot-angle"));
    light.inner_cone = 0.8F * light.outer_cone;
  }
  scene.lights.push_back(std::move(light));
}

}  // namespace

std::vector<ParamSpec> joinParams(std::initializer_list<std::vector<ParamSpec>> lists) {
  std::vector<ParamSpec> joined;
  for (const std::vector<ParamSpec>& list : lists) joined.insert(joined.end(), list.begin(), list.end());
  return joined;
}

std::vector<ParamSpec> lightParams(const LightSetting& setting) {
  const float distance = length(setting.target - setting.position);
  return {
      {"light",
       setting.kind,
       0,
       0,
       "",
       "what lights the scene; env is the analytic sky without the sun's disc",
       {"sun", "point", "spot", "area", "env"}},
      {"sun-elevation", setting.sun_elevation_deg, 0.0, 90.0, "deg", "height of the sun above the horizon", {}},
      {"sun-azimuth",
       setting.sun_azimuth_deg,
       -360.0,
       360.0,
       "deg",
       "where the sun stands: 0 is +Z (behind the viewer), 90 is +X (right)",
       {}},
      {"sun-angle", setting.sun_angle_deg, 0.0, 90.0, "deg", "angular diameter of the sun (the real one: 0.53)", {}},
      {"irradiance",
       kDefaultIrradiance,
       0.0,
       1e9,
       "W/m^2",
       "of the sun, perpendicular to its light; of the sky, on the ground",
       {}},
      {"light-position", setting.position, -kLongest, kLongest, "m", "of the point, spot or area light", {}},
      {"light-target", setting.target, -kLongest, kLongest, "m", "what the spot or area light faces", {}},
      {"light-radius", 0.0F, 0.0, kLongest, "m", "radius of the point or spot light's bulb", {}},
      {"light-width", roundToTwoDigits(0.1F * distance), 1e-9, kLongest, "m", "side of the square area light", {}},
      {"spot-angle", setting.spot_angle_deg, 0.1, 179.0, "deg", "full angle of the spot light's cone", {}},
      {"intensity",
       roundToTwoDigits(kDefaultIrradiance * distance * distance),
       0.0,
       1e12,
       "W/sr",
       "of the point or spot light, and of the area light along its axis",
       {}},
      {"light-color", vec3(1.0F), 0.0, 1e6, "", "linear RGB, multiplies irradiance and intensity", {}},
      {"turbidity", 3.0F, 1.7, 10.0, "", "haze of the sky: 2 is arctic, 3 clear, 6 a warm moist day, 10 haze", {}},
  };
}

void addLight(SceneData& scene, const ParamSet& params) {
  const std::string& kind = params.getString("light");
  if (kind == "env") {
    const vec3 color = params.getVec3("light-color");
    scene.environment = makeSky({.turbidity = params.getFloat("turbidity"),
                                 .elevation_deg = params.getFloat("sun-elevation"),
                                 .azimuth_deg = params.getFloat("sun-azimuth"),
                                 .irradiance = params.getFloat("irradiance"),
                                 .tint = color});
    return;
  }
  if (kind != "sun" && params.getVec3("light-target") == params.getVec3("light-position"))
    throw UsageError("light-target is the same point as light-position; move one of them");
  if (kind == "area") return addAreaLight(scene, params);
  addPunctualLight(scene, params,
                   kind == "sun"    ? LightKind::kSun
                   : kind == "spot" ? LightKind::kSpot
                                    : LightKind::kPoint);
}

std::vector<ParamSpec> floorParams(float size) {
  return {{"floor-size", size, 1e-6, kLongest, "m", "side of the square floor", {}},
          {"floor-color", vec3(0.7F), 0.0, 1.0, "", "linear RGB albedo of the diffuse floor", {}}};
}

void addFloor(SceneData& scene, const ParamSet& params, vec3 centre) {
  const double half = 0.5 * params.getFloat("floor-size");
  addObject(scene, makeRectangle("floor", centre, {half, 0, 0}, {0, 0, -half}),
            makeDiffuse("floor", params.getVec3("floor-color")));
}

std::vector<ParamSpec> segmentParams(int default_count, const std::string& text) {
  return {{"segments", default_count, default_count < 8 ? 1.0 : 8.0, 4096.0, "", text, {}}};
}

std::vector<ParamSpec> glassParams(float ior, vec3 color, float attenuation_distance) {
  return {
      {"ior", ior, 0.1, 10.0, "", "index of refraction at 587.6 nm", {}},
      {"abbe", 0.0F, 0.0, 1000.0, "", "Abbe number (crown 59, flint 36); 0: no dispersion", {}},
      {"dispersion", 0.0F, 0.0, 20.0, "", "the same as in glTF: 20 / Abbe number", {}},
      {"color", color, 0.0, 1.0, "", "linear RGB that white becomes after attenuation-distance inside", {}},
      {"attenuation-distance", attenuation_distance, 1e-9, 1e9, "m", "path after which white has become color", {}},
  };
}

Material makeGlass(const ParamSet& params, std::string name) {
  Material material;
  material.name = std::move(name);
  material.roughness = 0.0F;
  material.transmission = 1.0F;
  material.thickness = 1.0F;
  material.ior = params.getFloat("ior");
  const float abbe = params.getFloat("abbe");
  if (params.isSet("dispersion") && params.isSet("abbe"))
    throw UsageError("abbe and dispersion say the same thing; give only one of them");
  material.dispersion = abbe > 0.0F && !params.isSet("dispersion") ? 20.0F / abbe : params.getFloat("dispersion");
  material.attenuation_color = params.getVec3("color");
  if (material.attenuation_color != vec3(1.0F)) material.attenuation_distance = params.getFloat("attenuation-distance");
  return material;
}

std::vector<ParamSpec> casterParams(const std::string& material, float ior, vec3 color, float attenuation_distance) {
  std::vector<ParamSpec> specs = glassParams(ior, color, attenuation_distance);
  specs.insert(specs.begin(), {"material", material, 0, 0, "", "glass, or a mirror of metal", {"glass", "metal"}});
  for (ParamSpec& spec : specs)
    if (spec.name == "color")
      spec.text = "linear RGB; glass: what white becomes after attenuation-distance inside; metal: its reflectance";
  return specs;
}

Material makeCaster(const ParamSet& params, std::string name, const std::string& default_material) {
  const std::string& choice = params.getString("material");
  const bool default_color_fits = choice == default_material || params.isSet("color");
  if (choice == "metal") {
    // Polished silver, where the scene's own default is the clear white of glass.
    constexpr vec3 kSilver(0.97F, 0.96F, 0.91F);
    return makeMirror(std::move(name), default_color_fits ? params.getVec3("color") : kSilver);
  }
  Material material = makeGlass(params, std::move(name));
  if (!default_color_fits) material.attenuation_color = vec3(1.0F);
  return material;
}

Material makeMirror(std::string name, vec3 reflectance) {
  Material material;
  material.name = std::move(name);
  material.base_color = vec4(reflectance, 1.0F);
  material.metallic = 1.0F;
  material.roughness = 0.0F;
  return material;
}

Material makeDiffuse(std::string name, vec3 albedo) {
  Material material;
  material.name = std::move(name);
  material.base_color = vec4(albedo, 1.0F);
  material.roughness = 1.0F;
  material.specular_factor = 0.0F;
  return material;
}

std::uint32_t addObject(SceneData& scene, Mesh mesh, Material material, const mat4& world_from_object) {
  mesh.material = static_cast<std::uint32_t>(scene.materials.size());
  Instance instance;
  instance.name = mesh.name;
  instance.mesh = static_cast<std::uint32_t>(scene.meshes.size());
  instance.object = static_cast<std::uint32_t>(scene.instances.size());
  instance.world_from_object = world_from_object;
  scene.materials.push_back(std::move(material));
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back(std::move(instance));
  return static_cast<std::uint32_t>(scene.instances.size() - 1);
}

void addCamera(SceneData& scene, vec3 eye, vec3 target, float fov_deg) {
  scene.cameras.push_back(makeCamera("main", eye, target, radians(fov_deg)));
}

}  // namespace nephroid
