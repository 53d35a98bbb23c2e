// All light of a scene as a path sees it from the eye: sampled towards a point, and met by chance.
//
// Punctual lights with a size are spheres (point, spot) or discs at infinity (sun); every emissive instance is one
// entry with a table over its triangles; the environment is one entry with a table over its texels.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/math.h"
#include "core/sampling/distribution.h"
#include "scene/environment_map.h"
#include "trace/surface_material.h"
#include "trace/trace_scene.h"

namespace nephroid {

/// Light sampled towards a point.
struct LightSample {
  vec3 dir;             ///< unit, from the point to the light
  float distance = 0;   ///< m; infinite for sun and environment
  vec3 radiance{0.0F};  ///< W/m²/sr; for delta lights the irradiance on a surface facing it, W/m²
  float pdf = 0.0F;     ///< per solid angle, choice of light included; for delta lights the probability of the choice
  bool delta = false;   ///< cannot be met by chance
  std::uint32_t source = kNone;  ///< which light: see LightSet::sourceCount
  vec3 normal{0.0F};             ///< of the side of a mesh that shines here, unit; zero for other lights
};

/// A place on a light, or a direction of the sun, drawn without regard to whom it may shine at.
struct LightPlace {
  vec3 position{0.0F};  ///< m; of the sun, which is `at_infinity`, the unit direction towards it
  bool at_infinity = false;
  vec3 normal{0.0F};  ///< out of a mesh or a sphere, unit; zero for other lights
  float pdf = 0.0F;   ///< per area, 1/m², or of a sun with a size per solid angle; else of the choice of light
  std::uint32_t source = kNone;
  std::uint32_t triangle = 0;  ///< of a mesh, with the barycentric weights of its second and third corner
  float u = 0.0F, v = 0.0F;
};

/// A straight way from a light: what the densities of light paths depend on.
struct LightRay {
  vec3 arrival;        ///< where it ends, world, m
  vec3 dir;            ///< unit, along the travel of light
  float distance = 0;  ///< m, from the light; infinite for sun and environment
  vec3 normal{0.0F};   ///< of the side of a mesh that it leaves, unit; zero for other lights
};

/// Radiance of a punctual light, W/sr, along `dir` (travel): the spot's cone applied.
vec3 intensityAlong(const Light& light, vec3 dir);

class LightSet {
 public:
  LightSet(const TraceScene& scene, const MaterialTable& materials);

  bool empty() const { return entries_.empty(); }
  /// @param u_choice picks the light, @param u the place on it
  std::optional<LightSample> sample(vec3 position, float u_choice, vec2 u) const;

  /// A place on any light but the environment, for which nothing is drawn. @param u_choice, u  as for `sample`
  std::optional<LightPlace> samplePlace(float u_choice, vec2 u) const;
  /// What a place sends along `dir` (travel), over its density: W/sr, or W/m² across the light of a sun.
  vec3 emissionOf(const LightPlace& place, vec3 dir) const;
  /// From `position` to where light along the line from the place last left its source, m; infinite for the sun;
  /// nothing within a sphere, which shines outwards only.
  std::optional<float> distanceTo(const LightPlace& place, vec3 position) const;

  /// Light met by chance: radiance, and the density with which `sample` would have found the same direction. Where
  /// several lights lie behind each other, each is met on its own, as each is sampled on its own.
  struct Met {
    vec3 radiance{0.0F};
    float pdf = 0.0F;
    std::uint32_t source = kNone;
    float distance = kInfinity;  ///< m, from the origin of the ray, or the vertex
    vec3 normal{0.0F};           ///< as in LightSample
  };
  /// @param vertex  where the path last scattered
  Met metSurface(vec3 vertex, const SurfacePoint& point, vec3 dir) const;
  /// Calls `visit(Met)` for every sun and for the environment seen along a ray that left the scene.
  template <class Visit>
  void visitInfinity(vec3 dir, Visit&& visit) const {
    for (const std::uint32_t i : suns_) {
      const Met met = metSun(dir, i);
      if (met.pdf > 0.0F) visit(met);
    }
    if (environment_)
      visit(Met{environment_->radiance(dir), environment_probability_ * environment_->pdf(dir), sourceOfEnvironment()});
  }
  /// Calls `visit(Met)` for every sphere light that the ray enters before `t_max`. The spheres shine but block nothing,
  /// neither rays nor photons: they stand for a filament, not for a body.
  /// @param vertex  where the path last scattered: `sample` would have been called there
  template <class Visit>
  void visitSpheres(vec3 vertex, const Ray& ray, float t_max, Visit&& visit) const {
    for (const std::uint32_t i : spheres_) {
      const Met met = metSphere(vertex, ray, t_max, i);
      if (met.pdf > 0.0F) visit(met);
    }
  }

  /// That `sample` chooses among.
  std::size_t count() const { return entries_.size(); }
  // Lights are numbered: punctual ones as in SceneData::lights, then meshes, then the environment.
  std::uint32_t sourceCount() const { return sourceOfEnvironment() + 1; }
  std::uint32_t sourceOfMesh(std::size_t mesh_light) const {
    return static_cast<std::uint32_t>(probability_of_punctual_.size() + mesh_light);
  }
  std::uint32_t sourceOfEnvironment() const { return sourceOfMesh(mesh_lights_.size()); }
  /// Has no size: cannot be met by chance.
  bool isDelta(std::uint32_t source) const;
  bool anyMet() const;
  /// Of all lights that can be met by chance from `position`, and all ways to them, the least density with which
  /// `sample` finds one, 1/sr: infinite where none can be met, 0 where there is no bound: for surfaces that shine, for
  /// an environment, and within a sphere.
  float leastDensity(vec3 position) const;
  /// Density with which `sample(ray.arrival)` finds the light `source` along a ray from it: LightSample::pdf.
  float densityTowards(std::uint32_t source, const LightRay& ray) const;

  const EnvironmentMap* environment() const { return environment_ ? &*environment_ : nullptr; }

  /// One emissive instance.
  struct MeshLight {
    std::uint32_t instance;
    Distribution1D triangles;  ///< by area
    double area;               ///< m²
    vec3 mean_emission;        ///< W/m²/sr, textures ignored
    bool double_sided;
  };
  const std::vector<MeshLight>& meshLights() const { return mesh_lights_; }

 private:
  enum class Kind : std::uint8_t { kPunctual, kMesh, kEnvironment };
  struct Entry {
    Kind kind;
    std::uint32_t index;
    float probability;
  };
  void addEntry(Kind kind, std::size_t index, double weight);
  Met metSun(vec3 dir, std::uint32_t which) const;
  Met metSphere(vec3 vertex, const Ray& ray, float t_max, std::uint32_t which) const;
  LightPlace samplePunctualPlace(const Light& light, vec2 u) const;
  LightPlace sampleMeshPlace(const MeshLight& light, vec2 u) const;
  std::optional<LightSample> samplePunctual(const Light& light, vec3 position, vec2 u) const;
  std::optional<LightSample> sampleMesh(const MeshLight& light, vec3 position, vec2 u) const;

  const TraceScene& scene_;
  const MaterialTable& materials_;
  std::vector<MeshLight> mesh_lights_;
  std::vector<std::uint32_t> mesh_light_of_instance_;
  std::vector<float> probability_of_punctual_;
  std::vector<std::uint32_t> spheres_, suns_;  ///< indices into SceneData::lights
  std::optional<EnvironmentMap> environment_;
  float environment_probability_ = 0.0F;
  std::vector<float> mesh_probability_;
  std::vector<Entry> entries_;
  std::vector<double> weights_;
  std::optional<Distribution1D> choice_;
};

/// 1 − cos of half the sun's angular diameter.
double sunOneMinusCos(const Light& sun);
/// Radiance of a sun of finite size such that the irradiance perpendicular to it is `intensity`: E⊥ / (π sin²θ).
vec3 sunRadiance(const Light& sun);

}  // namespace nephroid
