// The scene: what every engine, technique and importer shares. Plain data; metres, watts, linear Rec. 709, Y up.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/math.h"

namespace nephroid {

/// "No index": a texture, mesh or material that is not there.
inline constexpr std::uint32_t kNone = 0xFFFFFFFFU;

enum class Wrap : std::uint8_t { kRepeat, kClamp, kMirror };

/// Texels, shared by everything that refers to them.
struct TextureImage {
  std::string name;
  DecodedImage image;
};

/// How a material uses an image.
struct TextureRef {
  std::uint32_t image = kNone;  ///< index into SceneData::images
  int texcoord = 0;             ///< which UV set, 0 or 1
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  bool nearest = false;         ///< no bilinear filter
  mat3 uv_from_texcoord{1.0F};  ///< KHR_texture_transform; (u, v, 1) column vectors
  bool valid() const { return image != kNone; }
};

enum class AlphaMode : std::uint8_t { kOpaque, kMask, kBlend };

/// glTF's metallic-roughness model with the extensions that bear on glass and metal.
struct Material {
  std::string name;
  vec4 base_color{1.0F};  ///< linear; alpha matters only by `alpha_mode`
  float metallic = 0.0F;
  float roughness = 1.0F;     ///< as in glTF; microfacet alpha = roughness²
  vec3 emission{0.0F};        ///< radiance, W/m²/sr: emissiveFactor × emissiveStrength
  float transmission = 0.0F;  ///< share of the dielectric base that transmits instead of scattering diffusely
  float ior = 1.5F;           ///< n_d; 0 never occurs (KHR's 0 is imported as a huge index)
  float dispersion = 0.0F;    ///< KHR_materials_dispersion: 20 / Abbe number
  float thickness = 0.0F;     ///< 0: thin-walled; anything else: solid (path lengths are real, the value is unused)
  vec3 attenuation_color{1.0F};
  float attenuation_distance = std::numeric_limits<float>::infinity();  ///< m, at which white becomes the colour
  float specular_factor = 1.0F;  ///< KHR_materials_specular: scales the dielectric Fresnel reflection
  vec3 specular_color{1.0F};     ///< ditto, per channel
  std::optional<vec3>
      conductor_ior;  ///< complex index n + i k of a metal per channel; replaces Schlick's F0 = base_color
  vec3 conductor_k{0.0F};
  float normal_scale = 1.0F;
  bool double_sided = false;  ///< bears on emission only: light and photons meet both sides of everything
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5F;
  int priority = 0;  ///< `extras.priority`: where solids overlap the highest wins, else the one entered last

  TextureRef base_color_texture;          ///< RGBA, sRGB-coded if 8-bit
  TextureRef metallic_roughness_texture;  ///< G roughness, B metallic, linear
  TextureRef normal_texture;              ///< tangent space, linear
  TextureRef emission_texture;            ///< sRGB-coded if 8-bit
  TextureRef transmission_texture;        ///< R, linear
  TextureRef specular_texture;            ///< A, linear
  TextureRef specular_color_texture;      ///< RGB, sRGB-coded if 8-bit

  bool transmits() const { return transmission > 0.0F; }
  /// Solid glass, water: light inside has another index and is absorbed. Thin-walled panes are not solid.
  /// A metallic texture may leave parts dielectric where its factor is 1.
  bool isSolidDielectric() const {
    return transmits() && thickness > 0.0F && (metallic < 1.0F || metallic_roughness_texture.valid());
  }
  bool emits() const { return emission.x > 0.0F || emission.y > 0.0F || emission.z > 0.0F; }
  /// Absorption coefficient per channel, 1/m: −ln(attenuation_color) / attenuation_distance.
  vec3 sigmaA() const;
};

/// Triangles with one material, in object space. Arrays other than positions and triangles may be empty;
/// those that are not have one entry per position. Counter-clockwise triangles look along +normal, out of the solid.
struct Mesh {
  std::string name;
  std::vector<vec3> positions;
  std::vector<vec3> normals;   ///< unit; empty: flat shading
  std::vector<vec4> tangents;  ///< xyz unit, w = ±1 handedness; empty: derived from texcoord0 where needed
  std::vector<vec2> texcoords[2];
  std::vector<vec4> colors;      ///< linear, multiplies base_color
  std::vector<uvec3> triangles;  ///< indices into positions, all in range
  std::uint32_t material = 0;

  Bounds bounds() const;
};

/// A mesh placed in the world. Where the determinant of `world_from_object` is negative the placement is mirrored:
/// whoever transforms the triangles must then exchange two corners of each to keep normals pointing out of the solid.
struct Instance {
  std::string name;  ///< the node's name
  std::uint32_t mesh = 0;
  mat4 world_from_object{1.0F};
  std::uint32_t object = 0;  ///< instances of one node share it: the parts of one thing
  bool casts = true;         ///< false: not a generator, whatever its material (`--object NAME:cast=false`)
};

enum class LightKind : std::uint8_t { kPoint, kSpot, kSun };

/// A punctual light, possibly with a size. Emissive meshes are materials, the environment is `Environment`.
struct Light {
  std::string name;
  LightKind kind = LightKind::kPoint;
  vec3 position{0.0F};         ///< point, spot; world
  vec3 direction{0, -1, 0};    ///< spot, sun: along the travel of light; world, unit
  vec3 intensity{1.0F};        ///< point, spot: W/sr; sun: irradiance perpendicular to it, W/m²
  float radius = 0.0F;         ///< point, spot: sphere of radiance intensity / (π radius²), m
  float angle_deg = 0.0F;      ///< sun: angular diameter, degrees
  float inner_cone = 0.0F;     ///< spot: half-angles, radians; full intensity inside `inner_cone`,
  float outer_cone = kPi / 4;  ///<       zero outside `outer_cone`, glTF's smooth fall-off between
};

/// Radiance from infinitely far away, lat-long: row 0 is +Y; u = 0.5 is −Z, u grows towards +X (u = 0.75).
struct Environment {
  std::shared_ptr<const Image> radiance;  ///< 3 channels, W/m²/sr before `scale`
  float rotation_deg = 0.0F;              ///< turns the environment about +Y, counter-clockwise seen from above
  float scale = 1.0F;
  std::string source;  ///< file name or "sky:…" for messages and metadata
};

struct Camera {
  std::string name;
  vec3 eye{0, 0, 5};
  vec3 forward{0, 0, -1};  ///< unit
  vec3 up{0, 1, 0};        ///< unit, perpendicular to forward
  float fov_y = kPi / 4;   ///< vertical angle of view, radians; perspective only
  float ortho_height = 0;  ///< height of the view in metres; 0: perspective
};

/// What there is to render, and what was said while loading it.
struct SceneData {
  std::string name;  ///< file name or "builtin:ring"
  std::vector<TextureImage> images;
  std::vector<Material> materials;  ///< never empty once loaded
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<Light> lights;
  std::optional<Environment> environment;
  std::vector<Camera> cameras;
  std::vector<std::string> warnings;  ///< what the file asks for and Nephroid does not do; what was added for it
  float duration = 0.0F;              ///< of the animation, s; 0: still

  /// Of everything that has triangles, world space.
  Bounds bounds() const;
  std::size_t triangleCount() const;
  const Material& materialOf(const Instance& instance) const { return materials[meshes[instance.mesh].material]; }
};

/// Camera that looks from `eye` to `target` with +Y up (or -Z up, where it looks straight up or down).
Camera makeCamera(std::string name, vec3 eye, vec3 target, float fov_y, float ortho_height = 0);

}  // namespace nephroid
