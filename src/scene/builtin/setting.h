// What the built-in scenes have in common: a light to choose, a floor, glass or metal to choose, one camera.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "core/params.h"
#include "scene/scene_data.h"

namespace nephroid {

/// The light a scene has unless told otherwise, and where its lamps stand.
struct LightSetting {
  std::string kind = "sun";      ///< sun, point, spot, area, env
  float sun_elevation_deg = 50;  ///< of where the sun stands
  float sun_azimuth_deg = 0;     ///< ditto; 0 is +Z, 90 is +X
  float sun_angle_deg = 0;       ///< angular diameter of the sun
  vec3 position{0, 1, 0};        ///< of the point, spot and area light, m
  vec3 target{0};                ///< what spot and area light face, and where they are as bright as the sun, m
  float spot_angle_deg = 40;     ///< full cone angle
};

/// Concatenates lists of parameters.
std::vector<ParamSpec> joinParams(std::initializer_list<std::vector<ParamSpec>> lists);

/// light, sun-elevation, sun-azimuth, sun-angle, irradiance, light-position, light-target, light-radius, light-width,
/// spot-angle, intensity, light-color, turbidity.
std::vector<ParamSpec> lightParams(const LightSetting& setting);
/// Adds the light that `lightParams` describe: a punctual light, a square emissive mesh that faces the target, or the
/// analytic sky (without the sun's disc).
void addLight(SceneData& scene, const ParamSet& params);

/// floor-size (m, side of a square) and floor-color.
std::vector<ParamSpec> floorParams(float size);
/// A horizontal diffuse square at height y about (centre.x, centre.z).
void addFloor(SceneData& scene, const ParamSet& params, vec3 centre = vec3(0));

/// segments (facets around).
std::vector<ParamSpec> segmentParams(int default_count, const std::string& text);

/// ior, abbe, dispersion, color, attenuation-distance.
std::vector<ParamSpec> glassParams(float ior, vec3 color, float attenuation_distance);
/// A clear solid dielectric as `glassParams` describe.
/// @throws UsageError if both abbe and dispersion are given
Material makeGlass(const ParamSet& params, std::string name);

/// `glassParams` and material (glass or metal): of metal, `color` is the reflectance instead.
std::vector<ParamSpec> casterParams(const std::string& material, float ior, vec3 color, float attenuation_distance);
/// Glass or a perfect mirror of metal. A colour that was not chosen becomes white when the material is not the default.
Material makeCaster(const ParamSet& params, std::string name, const std::string& default_material);

/// A mirror of metal with the given normal reflectance.
Material makeMirror(std::string name, vec3 reflectance);
/// A Lambertian surface: no specular lobe at all.
Material makeDiffuse(std::string name, vec3 albedo);

/// Adds material, mesh and instance as an object of its own; returns the index of the instance.
std::uint32_t addObject(SceneData& scene, Mesh mesh, Material material, const mat4& world_from_object = mat4(1.0F));

/// Adds the scene's camera, "main". @param fov_deg vertical angle of view
void addCamera(SceneData& scene, vec3 eye, vec3 target, float fov_deg);

}  // namespace nephroid
