#include "frame/light_views.h"

#include <algorithm>
#include <cmath>

#include "core/sampling/sampler.h"
#include "core/sampling/warp.h"
#include "frame/view.h"
#include "scene/texture.h"

namespace nephroid {
namespace {

/// Streams of the sampler, one for each light; those of pixels and photons of other engines do not matter here.
constexpr std::uint32_t kFirstStream = 0x11670000U;

bool isMirrored(const Instance& instance) { return glm::determinant(mat3(instance.world_from_object)) < 0.0F; }

/// World-space corners, wound so that their normal points out of the solid.
void fetchCorners(const SceneData& scene, const Instance& instance, std::size_t triangle, vec3 corners[3]) {
  const Mesh& mesh = scene.meshes[instance.mesh];
  const uvec3& t = mesh.triangles[triangle];
  for (int k = 0; k < 3; ++k) corners[k] = transformPoint(instance.world_from_object, mesh.positions[t[k]]);
  if (isMirrored(instance)) std::swap(corners[1], corners[2]);
}

/// A direction from the centre of a sphere light to a point of it.
///
/// From outside the scene mostly on the side that faces it, by the cosine, so that each sample brings about the same;
/// a share is spread evenly, because what is not straight below sees more than that side.
vec3 sampleSphere(const Bounds& scene, vec3 centre, vec2 u, float& pdf_solid_angle) {
  constexpr float kEven = 0.25F;
  const bool inside = scene.empty() || glm::clamp(centre, scene.lower, scene.upper) == centre;
  if (inside) {
    pdf_solid_angle = pdfSolidAngleUniformSphere();
    return sampleUniformSphere(u);
  }
  const Frame frame = Frame::fromZ(normalize(scene.centre() - centre));
  const bool even = u.x < kEven;
  u.x = std::min(even ? u.x / kEven : (u.x - kEven) / (1.0F - kEven), kOneMinusEpsilon);
  const vec3 local = even ? sampleUniformSphere(u) : sampleCosineHemisphere(u);
  pdf_solid_angle = kEven * pdfSolidAngleUniformSphere() + (1.0F - kEven) * pdfSolidAngleCosineHemisphere(local.z);
  return frame.toWorld(local);
}

}  // namespace

std::uint32_t LightTraits::fewCount() const { return count <= kMostFewLights ? count : 0; }

std::vector<gpu::Constant> LightTraits::constants() const {
  return {{12, fewCount()}, {13, points}, {14, directionals}, {15, spots}, {16, surfaces}};
}

bool LightTraits::cover(const LightTraits& others) const {
  const auto both = [](bool mine, bool other) { return mine || !other; };
  const bool counted = count <= kMostFewLights || others.count <= kMostFewLights;
  return (!counted || count == others.count) && both(points, others.points) &&
         both(directionals, others.directionals) && both(spots, others.spots) && both(surfaces, others.surfaces);
}

LightViews::LightViews(const SceneData& scene, std::uint32_t seed)
    : scene_(scene), bounds_(scene.bounds()), seed_(seed) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i) sources_.push_back({Kind::kPunctual, i});
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (!scene.materialOf(instance).emits()) continue;
    std::vector<float> areas;
    double area = 0;
    for (std::size_t t = 0; t < scene.meshes[instance.mesh].triangles.size(); ++t) {
      vec3 p[3];
      fetchCorners(scene, instance, t, p);
      areas.push_back(0.5F * length(cross(p[1] - p[0], p[2] - p[0])));
      area += areas.back();
    }
    if (!(area > 0.0)) continue;
    sources_.push_back({Kind::kMesh, mesh_lights_.size()});
    mesh_lights_.push_back({static_cast<std::uint32_t>(i), Distribution1D(areas), area});
  }
  if (!scene.environment || !scene.environment->radiance) return;
  environment_.emplace(*scene.environment);
  if (environment_->meanRadiance() > 0.0F) sources_.push_back({Kind::kEnvironment, 0});
}

LightTraits LightViews::traits() const {
  LightTraits traits;
  traits.count = static_cast<std::uint32_t>(sources_.size());
  for (const Source& source : sources_) {
    const Light* light = source.kind == Kind::kPunctual ? &scene_.lights[source.index] : nullptr;
    const bool sun = light != nullptr && light->kind == LightKind::kSun;
    const bool directional = sun || source.kind == Kind::kEnvironment;
    traits.directionals = traits.directionals || directional;
    traits.points = traits.points || !directional;
    traits.spots = traits.spots || (light != nullptr && light->kind == LightKind::kSpot);
    traits.surfaces =
        traits.surfaces || source.kind == Kind::kMesh || (light != nullptr && !sun && light->radius > 0.0F);
  }
  return traits;
}

bool LightViews::isOut(std::size_t index) const {
  const Source& source = sources_[index];
  return source.kind == Kind::kPunctual && !(luminance(scene_.lights[source.index].intensity) > 0.0F);
}

std::optional<LightView> LightViews::make(std::size_t index, std::uint32_t sample) const {
  Sampler sampler(seed_, kFirstStream + static_cast<std::uint32_t>(index), sample);
  const Source& source = sources_[index];
  const vec2 u = sampler.next2D();
  switch (source.kind) {
    case Kind::kPunctual:
      if (isOut(index)) return std::nullopt;
      return makePunctual(scene_.lights[source.index], u);
    case Kind::kMesh:
      return makeMesh(mesh_lights_[source.index], u);
    case Kind::kEnvironment:
      return makeEnvironment(u);
  }
  return std::nullopt;
}

void LightViews::addCube(LightView& view) const {
  view.light.view_count = 6;
  for (int face = 0; face < 6; ++face) view.views.push_back(makeCubeView(view.light.position, face, bounds_));
}

void LightViews::addParallel(LightView& view) const {
  view.light.view_count = 1;
  view.views.push_back(makeParallelView(view.light.direction, bounds_));
}

LightView LightViews::makePunctual(const Light& light, vec2 u) const {
  LightView view;
  LightRecord& record = view.light;
  record.value = light.intensity;
  record.direction = light.direction;
  if (light.kind == LightKind::kSun) {
    record.kind = kLightDirectional;
    if (light.angle_deg > 0.0F) {
      // Uniform in the solid angle of the disc: every direction brings the same share of ∫L dω. The irradiance that
      // faces the sun is ∫L cos α dω, and L is set so that this is the light's, with ∫cos α dω = π sin².
      const float sin_half = std::sin(0.5F * radians(light.angle_deg));
      const float one_minus_cos = sin_half * sin_half / (1.0F + std::sqrt(1.0F - sin_half * sin_half));
      record.direction = Frame::fromZ(light.direction).toWorld(sampleUniformCone(u, one_minus_cos));
      record.value = light.intensity * (2.0F * one_minus_cos / (sin_half * sin_half));
      view.varies = true;
    }
    addParallel(view);
    return view;
  }
  record.kind = light.kind == LightKind::kSpot ? kLightSpot : kLightPoint;
  record.position = light.position;
  record.cos_outer = std::cos(light.outer_cone);
  record.cos_inner = std::cos(light.inner_cone);
  if (light.radius > 0.0F) {
    float pdf = 0.0F;
    record.normal = sampleSphere(bounds_, light.position, u, pdf);
    record.position += light.radius * record.normal;
    // Radiance I/(πr²), and r²/pdf m² of the sphere for each sample.
    record.value = light.intensity / (kPi * pdf);
    record.surface = kSurfaceFront;
    view.varies = true;
  }
  addCube(view);
  return view;
}

std::optional<LightView> LightViews::makeMesh(const MeshLight& light, vec2 u) const {
  const auto choice = light.triangles.sample(u.x);
  const vec3 weights = sampleUniformTriangle(vec2(std::min(choice.offset, kOneMinusEpsilon), u.y));
  const Instance& instance = scene_.instances[light.instance];
  vec3 p[3];
  fetchCorners(scene_, instance, choice.index, p);
  const Material& material = scene_.materialOf(instance);
  LightView view;
  view.varies = true;
  LightRecord& record = view.light;
  record.kind = kLightPoint;
  record.normal = normalize(cross(p[1] - p[0], p[2] - p[0]));
  record.position = p[0] + weights.y * (p[1] - p[0]) + weights.z * (p[2] - p[0]);
  record.value = material.emission * static_cast<float>(light.area);
  if (material.emission_texture.valid()) {
    const TextureRef& reference = material.emission_texture;
    const Mesh& mesh = scene_.meshes[instance.mesh];
    const auto& uvs = mesh.texcoords[reference.texcoord];
    uvec3 t = mesh.triangles[choice.index];
    if (isMirrored(instance)) std::swap(t.y, t.z);
    const vec2 uv = uvs.empty() ? vec2(0.0F) : weights.x * uvs[t.x] + weights.y * uvs[t.y] + weights.z * uvs[t.z];
    record.value *= vec3(sampleTexture(scene_.images[reference.image], reference, uv, true));
  }
  record.surface = material.double_sided ? kSurfaceBoth : kSurfaceFront;
  addCube(view);
  return view;
}

std::optional<LightView> LightViews::makeEnvironment(vec2 u) const {
  float pdf_solid_angle = 0.0F;
  const vec3 dir = environment_->sample(u, pdf_solid_angle);
  if (!(pdf_solid_angle > 0.0F)) return std::nullopt;
  LightView view;
  view.varies = true;
  view.light.kind = kLightDirectional;
  view.light.direction = -dir;
  view.light.value = environment_->radiance(dir) / pdf_solid_angle;
  addParallel(view);
  return view;
}

}  // namespace nephroid
