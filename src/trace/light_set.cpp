#include "trace/light_set.h"

#include <algorithm>
#include <cmath>

#include "core/optics/lights.shared.h"
#include "core/sampling/warp.h"

namespace nephroid {
namespace {

/// Of the half-angle under which a sphere is seen. @param sin2  squared sine of it
float oneMinusCosOfSphere(float sin2) { return sin2 / (1.0F + std::sqrt(1.0F - sin2)); }  // without cancellation

}  // namespace

vec3 intensityAlong(const Light& light, vec3 dir) {
  if (light.kind != LightKind::kSpot) return light.intensity;
  return spotIntensity(light.intensity, light.direction, std::cos(light.inner_cone), std::cos(light.outer_cone), dir);
}

double sunOneMinusCos(const Light& sun) {
  const double half = 0.5 * radians(sun.angle_deg);
  const double s = std::sin(0.5 * half);
  return 2.0 * s * s;  // 1 − cos without cancellation
}

vec3 sunRadiance(const Light& sun) {
  const double s = std::sin(0.5 * radians(sun.angle_deg));
  return sun.intensity * static_cast<float>(1.0 / (kPi * s * s));
}

LightSet::LightSet(const TraceScene& scene, const MaterialTable& materials) : scene_(scene), materials_(materials) {
  const SceneData& data = scene.scene();
  const double radius = std::max(scene.bounds().radius(), 1e-30F);
  probability_of_punctual_.assign(data.lights.size(), 0.0F);
  for (std::size_t i = 0; i < data.lights.size(); ++i) {
    const Light& light = data.lights[i];
    const double brightness = luminance(light.intensity);
    if (!(brightness > 0.0)) continue;
    const bool is_sun = light.kind == LightKind::kSun;
    addEntry(Kind::kPunctual, i, brightness * (is_sun ? kPi * radius * radius : 4.0 * kPi));
    if (is_sun && light.angle_deg > 0.0F) suns_.push_back(static_cast<std::uint32_t>(i));
    if (!is_sun && light.radius > 0.0F) spheres_.push_back(static_cast<std::uint32_t>(i));
  }
  mesh_light_of_instance_.assign(data.instances.size(), kNone);
  for (std::uint32_t i = 0; i < data.instances.size(); ++i) {
    const Material& material = scene.materialOf(i);
    if (!material.emits()) continue;
    std::vector<float> areas;
    for (std::uint32_t t = 0; t < scene.triangleCountOf(i); ++t) {
      vec3 p[3];
      scene.triangleCorners(i, t, p);
      areas.push_back(0.5F * length(cross(p[1] - p[0], p[2] - p[0])));
    }
    double area = 0.0;
    for (const float a : areas) area += a;
    if (!(area > 0.0)) continue;
    mesh_light_of_instance_[i] = static_cast<std::uint32_t>(mesh_lights_.size());
    mesh_lights_.push_back({i, Distribution1D(areas), area, material.emission, material.double_sided});
    addEntry(Kind::kMesh, mesh_lights_.size() - 1, luminance(material.emission) * kPi * area);
  }
  if (data.environment && data.environment->radiance) {
    environment_.emplace(*data.environment);
    addEntry(Kind::kEnvironment, 0, environment_->meanRadiance() * 4.0 * kPi * kPi * radius * radius);
  }
  if (entries_.empty()) return;
  // Half by power, half evenly: a weak light near a receiver may matter more there than a strong one far away.
  double total = 0.0;
  for (const double w : weights_) total += w;
  std::vector<float> choice;
  for (const double w : weights_)
    choice.push_back(
        static_cast<float>(total > 0.0 ? 0.5 * w / total + 0.5 / static_cast<double>(weights_.size()) : 1.0));
  choice_.emplace(choice);
  mesh_probability_.assign(mesh_lights_.size(), 0.0F);
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    Entry& entry = entries_[e];
    entry.probability = choice_->probability(e);
    if (entry.kind == Kind::kPunctual) probability_of_punctual_[entry.index] = entry.probability;
    if (entry.kind == Kind::kMesh) mesh_probability_[entry.index] = entry.probability;
    if (entry.kind == Kind::kEnvironment) environment_probability_ = entry.probability;
  }
}

void LightSet::addEntry(Kind kind, std::size_t index, double weight) {
  entries_.push_back({kind, static_cast<std::uint32_t>(index), 0.0F});
  weights_.push_back(weight);
}

std::optional<LightSample> LightSet::sample(vec3 position, float u_choice, vec2 u) const {
  if (entries_.empty()) return std::nullopt;
  const Entry& entry = entries_[choice_->sample(u_choice).index];
  std::optional<LightSample> s;
  if (entry.kind == Kind::kPunctual) {
    s = samplePunctual(scene_.scene().lights[entry.index], position, u);
  } else if (entry.kind == Kind::kMesh) {
    s = sampleMesh(mesh_lights_[entry.index], position, u);
  } else {
    s.emplace();
    s->dir = environment_->sample(u, s->pdf);
    s->distance = kInfinity;
    s->radiance = environment_->radiance(s->dir);
  }
  if (!s || !(s->pdf > 0.0F)) return std::nullopt;
  s->source = entry.kind == Kind::kPunctual ? entry.index
              : entry.kind == Kind::kMesh   ? sourceOfMesh(entry.index)
                                            : sourceOfEnvironment();
  s->pdf *= entry.probability;
  return s;
}

std::optional<LightSample> LightSet::samplePunctual(const Light& light, vec3 position, vec2 u) const {
  LightSample s;
  if (light.kind == LightKind::kSun) {
    s.distance = kInfinity;
    if (light.angle_deg > 0.0F) {
      const auto one_minus_cos = static_cast<float>(sunOneMinusCos(light));
      s.dir = Frame::fromZ(-light.direction).toWorld(sampleUniformCone(u, one_minus_cos));
      s.pdf = 1.0F / (2.0F * kPi * one_minus_cos);
      s.radiance = sunRadiance(light);
    } else {
      s.dir = -light.direction;
      s.delta = true;
      s.pdf = 1.0F;
      s.radiance = irradianceFromSun(light.intensity, 1.0F);
    }
    return s;
  }
  const vec3 to_centre = light.position - position;
  const float squared = dot(to_centre, to_centre);
  if (!(squared > light.radius * light.radius) || squared == 0.0F) return std::nullopt;
  const float centre_distance = std::sqrt(squared);
  if (light.radius == 0.0F) {
    s.dir = to_centre / centre_distance;
    s.distance = centre_distance;
    s.delta = true;
    s.pdf = 1.0F;
    s.radiance = irradianceFromPoint(intensityAlong(light, -s.dir), squared, 1.0F);
    return s;
  }
  // The cone that the sphere subtends, uniformly.
  const float one_minus_cos = oneMinusCosOfSphere(light.radius * light.radius / squared);
  s.dir = Frame::fromZ(to_centre / centre_distance).toWorld(sampleUniformCone(u, one_minus_cos));
  const float along = dot(to_centre, s.dir);
  const vec3 beside = to_centre - along * s.dir;
  const float half_chord = std::sqrt(std::max(light.radius * light.radius - dot(beside, beside), 0.0F));
  s.distance = along - half_chord;
  s.pdf = 1.0F / (2.0F * kPi * one_minus_cos);
  s.radiance = intensityAlong(light, -s.dir) / (kPi * light.radius * light.radius);
  return s;
}

std::optional<LightSample> LightSet::sampleMesh(const MeshLight& light, vec3 position, vec2 u) const {
  const auto choice = light.triangles.sample(u.x);
  const auto triangle = static_cast<std::uint32_t>(choice.index);
  const vec3 barycentrics = sampleUniformTriangle(vec2(std::min(choice.offset, kOneMinusEpsilon), u.y));
  vec3 p[3];
  scene_.triangleCorners(light.instance, triangle, p);
  const vec3 target = p[0] + barycentrics.y * (p[1] - p[0]) + barycentrics.z * (p[2] - p[0]);
  const vec3 to = target - position;
  const float squared = dot(to, to);
  if (!(squared > 0.0F)) return std::nullopt;
  LightSample s;
  s.distance = std::sqrt(squared);
  s.dir = to / s.distance;
  const vec3 normal = normalize(cross(p[1] - p[0], p[2] - p[0]));
  const float cos_light = -dot(normal, s.dir);
  if (cos_light == 0.0F || (cos_light < 0.0F && !light.double_sided)) return std::nullopt;
  s.pdf = static_cast<float>(squared / (std::abs(cos_light) * light.area));
  SurfacePoint point{};
  point.instance = light.instance, point.triangle = triangle;
  point.u = barycentrics.y, point.v = barycentrics.z;
  s.radiance = materials_.emission(point, cos_light > 0.0F);
  s.normal = cos_light > 0.0F ? normal : -normal;
  return s;
}

std::optional<LightPlace> LightSet::samplePlace(float u_choice, vec2 u) const {
  if (entries_.empty()) return std::nullopt;
  const Entry& entry = entries_[choice_->sample(u_choice).index];
  if (entry.kind == Kind::kEnvironment) return std::nullopt;
  const bool punctual = entry.kind == Kind::kPunctual;
  LightPlace place = punctual ? samplePunctualPlace(scene_.scene().lights[entry.index], u)
                              : sampleMeshPlace(mesh_lights_[entry.index], u);
  place.source = punctual ? entry.index : sourceOfMesh(entry.index);
  place.pdf *= entry.probability;
  return place;
}

LightPlace LightSet::samplePunctualPlace(const Light& light, vec2 u) const {
  LightPlace place;
  place.pdf = 1.0F;
  if (light.kind == LightKind::kSun) {
    place.at_infinity = true;
    place.position = -light.direction;
    if (light.angle_deg == 0.0F) return place;
    const auto one_minus_cos = static_cast<float>(sunOneMinusCos(light));
    place.position = Frame::fromZ(-light.direction).toWorld(sampleUniformCone(u, one_minus_cos));
    place.pdf = 1.0F / (2.0F * kPi * one_minus_cos);
    return place;
  }
  place.position = light.position;
  if (light.radius == 0.0F) return place;
  place.normal = sampleUniformSphere(u);
  place.position += light.radius * place.normal;
  place.pdf = 1.0F / (4.0F * kPi * light.radius * light.radius);
  return place;
}

LightPlace LightSet::sampleMeshPlace(const MeshLight& light, vec2 u) const {
  LightPlace place;
  const auto choice = light.triangles.sample(u.x);
  place.triangle = static_cast<std::uint32_t>(choice.index);
  const vec3 weights = sampleUniformTriangle(vec2(std::min(choice.offset, kOneMinusEpsilon), u.y));
  place.u = weights.y, place.v = weights.z;
  vec3 p[3];
  scene_.triangleCorners(light.instance, place.triangle, p);
  place.position = p[0] + weights.y * (p[1] - p[0]) + weights.z * (p[2] - p[0]);
  place.normal = normalize(cross(p[1] - p[0], p[2] - p[0]));
  place.pdf = static_cast<float>(1.0 / light.area);
  return place;
}

vec3 LightSet::emissionOf(const LightPlace& place, vec3 dir) const {
  const float cos_theta = dot(place.normal, dir);
  if (place.source >= probability_of_punctual_.size()) {
    SurfacePoint point{};
    point.instance = mesh_lights_[place.source - probability_of_punctual_.size()].instance;
    point.triangle = place.triangle, point.u = place.u, point.v = place.v;
    return materials_.emission(point, cos_theta > 0.0F) * (std::abs(cos_theta) / place.pdf);
  }
  const Light& light = scene_.scene().lights[place.source];
  if (light.kind == LightKind::kSun)
    return (light.angle_deg > 0.0F ? sunRadiance(light) : irradianceFromSun(light.intensity, 1.0F)) / place.pdf;
  const vec3 intensity = intensityAlong(light, dir) / place.pdf;
  if (light.radius == 0.0F) return intensity;
  // A line through a sphere leaves it once but meets it twice: each place stands for half of what is sent along it.
  return intensity * (0.5F * std::abs(cos_theta) / (kPi * light.radius * light.radius));
}

std::optional<float> LightSet::distanceTo(const LightPlace& place, vec3 position) const {
  if (place.at_infinity) return kInfinity;
  const vec3 way = place.position - position;
  const float distance = length(way);
  if (isDelta(place.source) || place.source >= probability_of_punctual_.size()) return distance;
  const Light& light = scene_.scene().lights[place.source];
  const vec3 from_centre = position - light.position;
  if (dot(from_centre, from_centre) <= light.radius * light.radius) return std::nullopt;
  // From the far side of the sphere the line goes on through it, by twice the radius times its cosine.
  const float cos_theta = dot(place.normal, way) / distance;
  return distance - std::max(2.0F * light.radius * cos_theta, 0.0F);
}

LightSet::Met LightSet::metSurface(vec3 vertex, const SurfacePoint& point, vec3 dir) const {
  Met met;
  const std::uint32_t index = mesh_light_of_instance_[point.instance];
  if (index == kNone) return met;
  const float cos_light = -dot(point.normal_geometric, dir);
  met.radiance = materials_.emission(point, cos_light > 0.0F);
  const vec3 to = point.position - vertex;
  met.source = sourceOfMesh(index);
  met.distance = length(to);
  met.normal = cos_light > 0.0F ? point.normal_geometric : -point.normal_geometric;
  if (cos_light != 0.0F)
    met.pdf =
        static_cast<float>(dot(to, to) / (std::abs(cos_light) * mesh_lights_[index].area)) * mesh_probability_[index];
  return met;
}

LightSet::Met LightSet::metSun(vec3 dir, std::uint32_t which) const {
  const Light& sun = scene_.scene().lights[which];
  const auto one_minus_cos = static_cast<float>(sunOneMinusCos(sun));
  // 1 − cos of the angle from half the squared chord: exact for the small angles of a sun.
  const vec3 chord = dir + sun.direction;
  if (0.5F * dot(chord, chord) > one_minus_cos) return {};
  return {sunRadiance(sun), probability_of_punctual_[which] / (2.0F * kPi * one_minus_cos), which};
}

LightSet::Met LightSet::metSphere(vec3 vertex, const Ray& ray, float t_max, std::uint32_t which) const {
  const Light& light = scene_.scene().lights[which];
  const vec3 to_centre = light.position - ray.origin;
  const float along = dot(to_centre, ray.dir);
  const float squared = dot(to_centre, to_centre), radius_squared = light.radius * light.radius;
  if (along <= 0.0F || squared <= radius_squared) return {};
  const vec3 beside = to_centre - along * ray.dir;
  const float room = radius_squared - dot(beside, beside);
  if (room < 0.0F || along - std::sqrt(room) >= t_max) return {};
  const vec3 from_vertex = light.position - vertex;
  const float one_minus_cos = oneMinusCosOfSphere(std::min(radius_squared / dot(from_vertex, from_vertex), 1.0F));
  return {intensityAlong(light, -ray.dir) / (kPi * radius_squared),
          probability_of_punctual_[which] / (2.0F * kPi * one_minus_cos), which, along};
}

bool LightSet::isDelta(std::uint32_t source) const {
  if (source >= probability_of_punctual_.size()) return false;
  const Light& light = scene_.scene().lights[source];
  return (light.kind == LightKind::kSun ? light.angle_deg : light.radius) == 0.0F;
}

bool LightSet::anyMet() const {
  return !suns_.empty() || !spheres_.empty() || !mesh_lights_.empty() || environment_.has_value();
}

float LightSet::leastDensity(vec3 position) const {
  if (!mesh_lights_.empty() || environment_) return 0.0F;
  float least = kInfinity;
  const auto take = [&](std::uint32_t which, float one_minus_cos) {
    least = std::min(least, probability_of_punctual_[which] / (2.0F * kPi * one_minus_cos));
  };
  const std::vector<Light>& lights = scene_.scene().lights;
  for (const std::uint32_t which : suns_) take(which, static_cast<float>(sunOneMinusCos(lights[which])));
  for (const std::uint32_t which : spheres_) {
    const vec3 to_centre = lights[which].position - position;
    const float sin2 = lights[which].radius * lights[which].radius / dot(to_centre, to_centre);
    if (!(sin2 < 1.0F)) return 0.0F;
    take(which, oneMinusCosOfSphere(sin2));
  }
  return least;
}

float LightSet::densityTowards(std::uint32_t source, const LightRay& ray) const {
  if (source == sourceOfEnvironment()) return environment_probability_ * environment_->pdf(-ray.dir);
  if (source < probability_of_punctual_.size()) {
    const float probability = probability_of_punctual_[source];
    if (isDelta(source)) return probability;
    const Light& light = scene_.scene().lights[source];
    if (light.kind == LightKind::kSun) return probability / (2.0F * kPi * static_cast<float>(sunOneMinusCos(light)));
    const vec3 to_centre = light.position - ray.arrival;
    const float squared = dot(to_centre, to_centre), radius_squared = light.radius * light.radius;
    // From inside, `sample` finds nothing.
    if (squared <= radius_squared) return 0.0F;
    return probability / (2.0F * kPi * oneMinusCosOfSphere(radius_squared / squared));
  }
  const std::size_t mesh = source - probability_of_punctual_.size();
  const float cos_light = dot(ray.normal, ray.dir);
  return cos_light > 0.0F ? static_cast<float>(ray.distance * ray.distance / (cos_light * mesh_lights_[mesh].area)) *
                                mesh_probability_[mesh]
                          : 0.0F;
}

}  // namespace nephroid
