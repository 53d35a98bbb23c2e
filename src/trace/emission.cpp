#include "trace/emission.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/sampling/warp.h"
#include "trace/masked_grid.h"

namespace nephroid {
namespace {

/// Cells along each side of an emission mask. The mask's border wastes photons on a band one cell wide: about 1 % at
/// 512 for a compact target. A power of two, for the quadtree.
constexpr int kMaskSize = 512;
/// Cells by which a sun's own width may blur a shadow before triangles are no longer marked one by one.
constexpr float kCoarseMargin = 8.0F;
/// Photons of the pilot that estimates the flux of area lights and environments.
constexpr int kPilotCount = 4096;

struct Triangle {
  vec3 p[3];
};

vec3 centroid(const Triangle& t) { return (t.p[0] + t.p[1] + t.p[2]) * (1.0F / 3.0F); }

/// Halves `triangle` across its longest edge until each part is below `limit` as seen from `eye`, `depth` times at
/// most. Long thin triangles thus make as many parts as they are long, not as their length squared.
template <class Visit>
void visitParts(const Triangle& triangle, vec3 eye, float limit, int depth, Visit&& visit) {
  const vec3 c = centroid(triangle);
  float radius = 0.0F;
  for (const vec3& p : triangle.p) radius = std::max(radius, length(p - c));
  const float distance = length(c - eye);
  if (depth == 0 || radius <= limit * distance) {
    visit(c, radius, distance);
    return;
  }
  int longest = 0;
  for (int k = 1; k < 3; ++k) {
    const vec3 edge = triangle.p[(k + 1) % 3] - triangle.p[k];
    const vec3 best = triangle.p[(longest + 1) % 3] - triangle.p[longest];
    if (dot(edge, edge) > dot(best, best)) longest = k;
  }
  const vec3 from = triangle.p[longest], to = triangle.p[(longest + 1) % 3], tip = triangle.p[(longest + 2) % 3];
  const vec3 middle = 0.5F * (from + to);
  visitParts(Triangle{{from, middle, tip}}, eye, limit, depth - 1, visit);
  visitParts(Triangle{{middle, to, tip}}, eye, limit, depth - 1, visit);
}

// ---------------------------------------------------------------------------------------------------- sun

class SunEmitter final : public Emitter {
 public:
  SunEmitter(const TraceScene& scene, const Light& light, const EmissionTargets& targets)
      : frame_(Frame::fromZ(light.direction)), bounds_(scene.bounds()), mask_(kMaskSize, kMaskSize) {
    sin_half_angle_ = std::sin(0.5F * radians(light.angle_deg));
    const float tan_half_angle = sin_half_angle_ / std::sqrt(std::max(1.0F - sin_half_angle_ * sin_half_angle_, 1e-6F));
    origin_ = targets.bounds().centre();
    // Extent of the targets on the plane, widened by what a tilted ray can be off at their depth.
    vec2 lower(kInfinity), upper(-kInfinity);
    const auto widen = [&](vec3 local) { return std::abs(local.z) * tan_half_angle; };
    targets.visitTriangles([&](const vec3* p) {
      for (int k = 0; k < 3; ++k) {
        const vec3 local = frame_.toLocal(p[k] - origin_);
        lower = glm::min(lower, vec2(local) - widen(local));
        upper = glm::max(upper, vec2(local) + widen(local));
      }
    });
    // A target seen edge-on has no extent; a sliver keeps the grid regular, and its flux is zero with its area.
    const float size = std::max({upper.x - lower.x, upper.y - lower.y, 1e-6F * targets.bounds().radius()});
    extent_ = glm::max((upper - lower) * 1.0001F, vec2(1e-4F * size));
    lower_ = 0.5F * (lower + upper) - 0.5F * extent_;
    // A wide sun blurs every shadow over many cells: then clusters say as much as triangles, and are few.
    if (targets.bounds().radius() * tan_half_angle > kCoarseMargin * (extent_.x + extent_.y) / kMaskSize) {
      for (const EmissionTargets::Sphere& cluster : targets.clusters()) {
        const vec3 local = frame_.toLocal(cluster.centre - origin_);
        markDisc(vec2(local), cluster.radius + (std::abs(local.z) + cluster.radius) * tan_half_angle);
      }
    } else {
      targets.visitTriangles([&](const vec3* p) {
        vec2 corners[3];
        float margin = 0.0F;
        for (int k = 0; k < 3; ++k) {
          const vec3 local = frame_.toLocal(p[k] - origin_);
          corners[k] = vec2(local);
          margin = std::max(margin, widen(local));
        }
        markTriangle(corners, margin);
      });
    }
    mask_.finish();
    area_ = mask_.markedFraction() * extent_.x * extent_.y;
    expected_flux_ = light.intensity * static_cast<float>(area_);
    name_ = light.name;
  }

  EmittedPhoton emit(Sampler& sampler, vec3& normal_out) const override {
    normal_out = vec3(0.0F);
    float density = 1.0F;
    const vec2 uv = mask_.sample(drawPlace(sampler, density));
    vec3 dir = frame_.z;
    if (sin_half_angle_ > 0.0F) {
      // Uniform in projected solid angle: a disc of uniform radiance gives every photon the same flux.
      const vec2 disc = sin_half_angle_ * sampleConcentricDisc(sampler.next2D());
      dir = frame_.toWorld(vec3(disc, std::sqrt(std::max(1.0F - dot(disc, disc), 0.0F))));
    }
    const vec2 place = lower_ + uv * extent_;
    const vec3 on_plane = origin_ + place.x * frame_.x + place.y * frame_.y;
    EmittedPhoton photon;
    photon.dir = dir;
    photon.origin = on_plane - dir * distanceToLeave(on_plane, -dir);
    photon.flux = expected_flux_ / density;
    return photon;
  }
  float arrivalDensity(const LightRay& ray) const override {
    const double directions = kPi * sin_half_angle_ * sin_half_angle_;
    return densityAlong(ray.arrival, ray.dir) *
           static_cast<float>(1.0 / (sin_half_angle_ > 0.0F ? area_ * directions : area_));
  }
  EmissionExtent extentOf(const EmittedPhoton&) const override {
    return {static_cast<float>(std::sqrt(area_)), std::sqrt(kPi) * sin_half_angle_};
  }
  bool canBeGuided() const override { return true; }

 private:
  /// Marks the cells of the box [low, high] of the plane whose centres pass `inside`.
  template <class Inside>
  void markBox(vec2 low, vec2 high, Inside&& inside) {
    const vec2 cell = extent_ / static_cast<float>(kMaskSize);
    const auto clampCell = [](float x) { return std::clamp(static_cast<int>(std::floor(x)), 0, kMaskSize - 1); };
    const vec2 first = (low - lower_) / cell, last = (high - lower_) / cell;
    for (int y = clampCell(first.y); y <= clampCell(last.y); ++y)
      for (int x = clampCell(first.x); x <= clampCell(last.x); ++x)
        if (!mask_.isMarked(x, y) &&
            inside(lower_ + cell * vec2(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F)))
          mask_.mark(x, y);
  }
  float densityAlong(vec3 position, vec3 dir) const {
    if (!guide_) return 1.0F;
    const vec3 local = frame_.toLocal(position - origin_), along = frame_.toLocal(dir);
    const vec2 on_plane = vec2(local) - vec2(along) * (local.z / along.z);
    return densityAt(mask_.invert((on_plane - lower_) / extent_));
  }
  float cellReach() const { return 0.5F * length(extent_) / static_cast<float>(kMaskSize); }

  void markDisc(vec2 centre, float radius) {
    const float reach = radius + cellReach();
    markBox(centre - reach, centre + reach, [&](vec2 p) { return dot(p - centre, p - centre) <= reach * reach; });
  }
  void markTriangle(const vec2* corners, float margin) {
    const float reach = margin + cellReach();
    const vec2 e0 = corners[1] - corners[0], e1 = corners[2] - corners[0];
    const float orientation = e0.x * e1.y - e0.y * e1.x < 0.0F ? -1.0F : 1.0F;
    markBox(glm::min(corners[0], glm::min(corners[1], corners[2])) - reach,
            glm::max(corners[0], glm::max(corners[1], corners[2])) + reach, [&](vec2 p) {
              for (int k = 0; k < 3; ++k) {
                const vec2 a = corners[k], edge = corners[(k + 1) % 3] - a;
                const float side = orientation * (edge.x * (p.y - a.y) - edge.y * (p.x - a.x));
                if (side < -reach * length(edge)) return false;
              }
              return true;
            });
  }
  /// Distance along `dir` until the scene's box is behind: far enough that nothing could block before the start, and no
  /// farther, because single precision counts from the origin of a ray.
  float distanceToLeave(vec3 from, vec3 dir) const {
    float leave = kInfinity;
    for (int k = 0; k < 3; ++k) {
      if (dir[k] == 0.0F) continue;
      const float t = ((dir[k] > 0.0F ? bounds_.upper[k] : bounds_.lower[k]) - from[k]) / dir[k];
      leave = std::min(leave, t);
    }
    return std::max(leave, 0.0F) * 1.001F + 1e-4F * bounds_.radius();
  }

  Frame frame_;
  Bounds bounds_;
  MaskedGrid mask_;
  vec3 origin_;
  vec2 lower_, extent_;
  float sin_half_angle_;
  double area_;
};

// ---------------------------------------------------------------------------------------------------- point, spot

class PointEmitter final : public Emitter {
 public:
  PointEmitter(const Light& light, const EmissionTargets& targets) : light_(light), mask_(kMaskSize, kMaskSize) {
    const vec3 to_targets = targets.bounds().centre() - light.position;
    const float distance = length(to_targets), reach = targets.bounds().radius() * 1.001F + light.radius;
    const bool surrounded = distance <= reach;
    frame_ = Frame::fromZ(distance > 0.0F ? to_targets / distance : vec3(0, 0, 1));
    const float sine = surrounded ? 1.0F : reach / distance;
    one_minus_cos_ = surrounded ? 2.0F : sine * sine / (1.0F + std::sqrt(1.0F - sine * sine));
    markTargets(targets);
    mask_.finish();
    solid_angle_ = 2.0 * kPi * one_minus_cos_ * mask_.markedFraction();
    expected_flux_ = meanIntensity() * static_cast<float>(solid_angle_);
    name_ = light.name;
  }

  EmittedPhoton emit(Sampler& sampler, vec3& normal_out) const override {
    normal_out = vec3(0.0F);
    EmittedPhoton photon;
    float density = 1.0F;
    photon.dir = frame_.toWorld(capFromSquare(mask_.sample(drawPlace(sampler, density)), one_minus_cos_));
    photon.origin = light_.position;
    if (light_.radius > 0.0F) {
      // A sphere of uniform radiance shows every direction the same disc: a place on the disc, moved to the surface.
      const vec2 disc = light_.radius * sampleConcentricDisc(sampler.next2D());
      const float rise = std::sqrt(std::max(light_.radius * light_.radius - dot(disc, disc), 0.0F));
      photon.origin += Frame::fromZ(photon.dir).toWorld(vec3(disc, rise));
    }
    photon.flux = intensityAlong(light_, photon.dir) * static_cast<float>(solid_angle_ / density);
    return photon;
  }
  float arrivalDensity(const LightRay& ray) const override {
    const float area = light_.radius > 0.0F ? kPi * light_.radius * light_.radius : ray.distance * ray.distance;
    return densityTowards(ray.dir) / static_cast<float>(solid_angle_ * area);
  }
  EmissionExtent extentOf(const EmittedPhoton&) const override {
    return {std::sqrt(kPi) * light_.radius, static_cast<float>(std::sqrt(solid_angle_))};
  }
  bool canBeGuided() const override { return true; }

 private:
  float densityTowards(vec3 dir) const {
    return guide_ ? densityAt(mask_.invert(squareFromCap(frame_.toLocal(dir), one_minus_cos_))) : 1.0F;
  }
  void markTargets(const EmissionTargets& targets) {
    const float cell_angle = std::sqrt(2.0F * kPi * one_minus_cos_) / static_cast<float>(kMaskSize);
    // Parts need not be much smaller than the light that looks at them.
    const float light_angle = light_.radius / std::max(length(targets.bounds().centre() - light_.position), 1e-30F);
    const float part_angle = std::max(4.0F * cell_angle, 0.35F * light_angle);
    CapMerger caps(std::max(0.25F * cell_angle, 0.2F * light_angle));
    bool everything = false;
    targets.visitTriangles([&](const vec3* p) {
      visitParts(Triangle{{p[0], p[1], p[2]}}, light_.position, part_angle, 14,
                 [&](vec3 c, float radius, float distance) {
                   const float sine = (radius * 1.001F + light_.radius) / std::max(distance, 1e-30F);
                   if (sine >= 1.0F) {
                     everything = true;
                     return;
                   }
                   caps.add({frame_.toLocal((c - light_.position) / distance), std::sqrt(1.0F - sine * sine), sine});
                 });
    });
    if (everything) {
      one_minus_cos_ = 2.0F;
      markCaps(mask_, one_minus_cos_, {{vec3(0, 0, 1), -1.0F, 0.0F}});
    } else {
      markCaps(mask_, one_minus_cos_, caps.caps());
    }
    if (light_.kind == LightKind::kSpot) intersectWithCone();
  }
  /// Unmarks what lies wholly outside a spot's cone.
  void intersectWithCone() {
    MaskedGrid cone(kMaskSize, kMaskSize), both(kMaskSize, kMaskSize);
    markCaps(cone, one_minus_cos_,
             {{frame_.toLocal(light_.direction), std::cos(light_.outer_cone), std::sin(light_.outer_cone)}});
    for (int y = 0; y < kMaskSize; ++y)
      for (int x = 0; x < kMaskSize; ++x)
        if (mask_.isMarked(x, y) && cone.isMarked(x, y)) both.mark(x, y);
    mask_ = both;
  }
  vec3 meanIntensity() const {
    if (mask_.markedCount() == 0) return vec3(0.0F);
    if (light_.kind == LightKind::kPoint) return light_.intensity;
    vec3 sum(0.0F);
    for (std::uint32_t i = 0; i < kPilotCount; ++i) {
      Sampler pilot(0, 0x5107, i);
      sum += intensityAlong(light_, frame_.toWorld(capFromSquare(mask_.sample(pilot.next2D()), one_minus_cos_)));
    }
    return sum / static_cast<float>(kPilotCount);
  }

  const Light& light_;
  Frame frame_;
  MaskedGrid mask_;
  float one_minus_cos_;
  double solid_angle_;
};

// ---------------------------------------------------------------------------------------------------- mesh

class MeshEmitter final : public Emitter {
 public:
  MeshEmitter(const TraceScene& scene, const MaterialTable& materials, const LightSet::MeshLight& light,
              const EmissionTargets& targets)
      : scene_(scene), materials_(materials), light_(light), targets_(targets) {
    name_ = scene.scene().instances[light.instance].name;
  }

  EmittedPhoton emit(Sampler& sampler, vec3& normal_out) const override {
    EmittedPhoton photon;
    const vec2 u_place = sampler.next2D(), u_dir = sampler.next2D(), u_choice = sampler.next2D();
    const auto choice = light_.triangles.sample(u_place.x);
    const vec3 barycentrics = sampleUniformTriangle(vec2(std::min(choice.offset, kOneMinusEpsilon), u_place.y));
    vec3 p[3];
    scene_.triangleCorners(light_.instance, static_cast<std::uint32_t>(choice.index), p);
    vec3 normal = normalize(cross(p[1] - p[0], p[2] - p[0]));
    SurfacePoint point{};
    point.position = barycentrics.x * p[0] + barycentrics.y * p[1] + barycentrics.z * p[2];
    point.instance = light_.instance, point.triangle = static_cast<std::uint32_t>(choice.index);
    point.u = barycentrics.y, point.v = barycentrics.z;
    point.normal_geometric = normal;
    point.position_error = 0x1p-19F * (maxComponent(glm::abs(point.position)) + length(p[1] - p[0]));
    const bool front = !light_.double_sided || u_choice.y < 0.5F;
    if (!front) normal = -normal;
    normal_out = normal;
    float density = 0.0F;
    photon.dir = aim(point.position, normal, u_dir, u_choice.x, density);
    photon.origin = offsetOrigin(point, photon.dir);
    const float cos_theta = dot(photon.dir, normal);
    if (density > 0.0F && cos_theta > 0.0F)
      photon.flux = materials_.emission(point, front) *
                    static_cast<float>(light_.area * cos_theta * (light_.double_sided ? 2.0 : 1.0) / density);
    return photon;
  }
  float arrivalDensity(const LightRay& ray) const override {
    const float cos_theta = dot(ray.dir, ray.normal);
    if (cos_theta <= 0.0F) return 0.0F;
    Cone cones[EmissionTargets::kMaxClusters];
    const vec3 place = ray.arrival - ray.distance * ray.dir;
    const float total = fillCones(place, ray.normal, cones);
    return total > 0.0F ? aimDensity(cones, total, ray.dir, kNone) /
                              static_cast<float>(light_.area * cos_theta * (light_.double_sided ? 2.0 : 1.0))
                        : 0.0F;
  }
  EmissionExtent extentOf(const EmittedPhoton& photon) const override {
    // Flux over radiance is the volume of phase space; textures are taken at their mean.
    const float place = static_cast<float>(std::sqrt(light_.area));
    const float emission = luminance(light_.mean_emission);
    if (!(emission > 0.0F)) return {};
    return {place, std::min(std::sqrt(luminance(photon.flux) / emission) / place, std::sqrt(2.0F * kPi))};
  }

 private:
  struct Cone {
    vec3 axis;
    float one_minus_cos;
  };
  /// The cone about a cluster as seen from `position`, or the hemisphere from inside the cluster; nothing if hidden.
  static Cone coneTo(const EmissionTargets::Sphere& cluster, vec3 position, vec3 normal) {
    const vec3 to = cluster.centre - position;
    const float squared = dot(to, to), radius = cluster.radius * 1.001F;
    if (squared <= radius * radius) return {normal, 1.0F};
    if (dot(to, normal) + radius <= 0.0F) return {normal, 0.0F};
    const float sin2 = radius * radius / squared;
    return {to / std::sqrt(squared), sin2 / (1.0F + std::sqrt(1.0F - sin2))};
  }
  /// @param cones  as many as there are clusters  @return the sum of their 1 − cos
  float fillCones(vec3 position, vec3 normal, Cone* cones) const {
    const auto& clusters = targets_.clusters();
    float total = 0.0F;
    for (std::size_t k = 0; k < clusters.size(); ++k) {
      cones[k] = coneTo(clusters[k], position, normal);
      total += cones[k].one_minus_cos;
    }
    return total;
  }
  /// Per solid angle. @param chosen  the cone that the direction was drawn from, whatever rounding says; kNone: unknown
  float aimDensity(const Cone* cones, float total, vec3 dir, std::size_t chosen) const {
    int count = 0;
    for (std::size_t k = 0; k < targets_.clusters().size(); ++k) {
      const vec3 chord = dir - cones[k].axis;
      if (cones[k].one_minus_cos > 0.0F && (k == chosen || 0.5F * dot(chord, chord) <= cones[k].one_minus_cos)) ++count;
    }
    return static_cast<float>(count) / (2.0F * kPi * total);
  }
  vec3 aim(vec3 position, vec3 normal, vec2 u, float u_choice, float& density) const {
    Cone cones[EmissionTargets::kMaxClusters];
    const auto& clusters = targets_.clusters();
    const float total = fillCones(position, normal, cones);
    if (total <= 0.0F) return normal;
    float rest = u_choice * total;
    std::size_t chosen = 0;
    for (; chosen + 1 < clusters.size() && rest >= cones[chosen].one_minus_cos; ++chosen)
      rest -= cones[chosen].one_minus_cos;
    const vec3 dir = Frame::fromZ(cones[chosen].axis).toWorld(sampleUniformCone(u, cones[chosen].one_minus_cos));
    density = aimDensity(cones, total, dir, chosen);
    return dir;
  }

  const TraceScene& scene_;
  const MaterialTable& materials_;
  const LightSet::MeshLight& light_;
  const EmissionTargets& targets_;
};

// ---------------------------------------------------------------------------------------------------- environment

class EnvironmentEmitter final : public Emitter {
 public:
  EnvironmentEmitter(const TraceScene& scene, const EnvironmentMap& map, const EmissionTargets& targets)
      : bounds_(scene.bounds()), map_(map), targets_(targets) {
    name_ = "environment";
    std::vector<float> areas;
    for (const auto& cluster : targets.clusters()) areas.push_back(cluster.radius * cluster.radius);
    choice_ = std::make_unique<Distribution1D>(areas);
  }

  EmittedPhoton emit(Sampler& sampler, vec3& normal_out) const override {
    normal_out = vec3(0.0F);
    EmittedPhoton photon;
    const vec2 u_dir = sampler.next2D(), u_place = sampler.next2D();
    const float u_choice = sampler.next1D();
    float pdf_dir = 0.0F;
    const vec3 to = map_.sample(u_dir, pdf_dir);
    photon.dir = -to;
    const Frame frame = Frame::fromZ(photon.dir);
    const auto& clusters = targets_.clusters();
    const auto& cluster = clusters[choice_->sample(u_choice).index];
    const vec2 disc = cluster.radius * sampleConcentricDisc(u_place);
    const vec3 on_disc = cluster.centre + disc.x * frame.x + disc.y * frame.y;
    // Discs are chosen by area, so the density is the number of discs here over the area of all.
    const int count = countDiscs(on_disc, photon.dir, &cluster);
    const vec3 centre = bounds_.centre();
    const float back = dot(on_disc - centre, photon.dir) + bounds_.radius() * 1.001F;
    photon.origin = on_disc - photon.dir * std::max(back, 0.0F);
    if (pdf_dir > 0.0F)
      photon.flux =
          map_.radiance(to) * static_cast<float>(kPi * choice_->total() / (static_cast<double>(count) * pdf_dir));
    return photon;
  }
  float arrivalDensity(const LightRay& ray) const override {
    return map_.pdf(-ray.dir) * static_cast<float>(countDiscs(ray.arrival, ray.dir, nullptr)) /
           static_cast<float>(kPi * choice_->total());
  }
  EmissionExtent extentOf(const EmittedPhoton& photon) const override {
    const float pdf_dir = map_.pdf(-photon.dir);
    if (!(pdf_dir > 0.0F)) return {};
    return {static_cast<float>(std::sqrt(kPi * choice_->total())), 1.0F / std::sqrt(pdf_dir)};
  }

 private:
  /// Discs that the line through `place` along `dir` meets. @param chosen  meets it, whatever rounding says; may be
  /// null
  int countDiscs(vec3 place, vec3 dir, const EmissionTargets::Sphere* chosen) const {
    int count = 0;
    for (const EmissionTargets::Sphere& disc : targets_.clusters()) {
      const vec3 offset = cross(disc.centre - place, dir);
      if (&disc == chosen || dot(offset, offset) <= disc.radius * disc.radius) ++count;
    }
    return count;
  }

  Bounds bounds_;
  const EnvironmentMap& map_;
  const EmissionTargets& targets_;
  std::unique_ptr<Distribution1D> choice_;
};

vec3 runPilot(const Emitter& emitter) {
  dvec3 sum(0.0);
  for (std::uint32_t i = 0; i < kPilotCount; ++i) {
    Sampler sampler(0, 0x9107, i);
    sum += dvec3(emitter.emit(sampler).flux);
  }
  return vec3(sum / static_cast<double>(kPilotCount));
}

}  // namespace

EmissionTargets::EmissionTargets(const TraceScene& scene, const std::vector<bool>& is_target) : scene_(scene) {
  for (std::uint32_t i = 0; i < is_target.size(); ++i)
    if (is_target[i]) instances_.push_back(i);
  visitTriangles([&](const vec3* p) {
    for (int k = 0; k < 3; ++k) bounds_.add(p[k]);
  });
}

const std::vector<EmissionTargets::Sphere>& EmissionTargets::clusters() const {
  std::call_once(clusters_built_, [this] { clusters_ = buildClusters(); });
  return clusters_;
}

std::vector<EmissionTargets::Sphere> EmissionTargets::buildClusters() const {
  std::vector<Sphere> clusters;
  std::vector<Triangle> triangles;
  visitTriangles([&](const vec3* p) { triangles.push_back({{p[0], p[1], p[2]}}); });
  if (triangles.empty()) return clusters;
  struct Range {
    std::size_t begin, end;
  };
  std::vector<Range> ranges{{0, triangles.size()}};
  // Median splits along the longest axis of the centroids, widest ranges first, until there are enough.
  for (std::size_t r = 0; r < ranges.size() && ranges.size() < static_cast<std::size_t>(kMaxClusters); ++r) {
    const Range range = ranges[r];
    if (range.end - range.begin < 2) continue;
    Bounds centroids;
    for (std::size_t i = range.begin; i < range.end; ++i) centroids.add(centroid(triangles[i]));
    const vec3 extent = centroids.extent();
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::size_t middle = (range.begin + range.end) / 2;
    std::nth_element(triangles.begin() + static_cast<std::ptrdiff_t>(range.begin),
                     triangles.begin() + static_cast<std::ptrdiff_t>(middle),
                     triangles.begin() + static_cast<std::ptrdiff_t>(range.end),
                     [axis](const Triangle& a, const Triangle& b) { return centroid(a)[axis] < centroid(b)[axis]; });
    ranges[r] = {range.begin, 0};  // replaced by its halves
    ranges.push_back({range.begin, middle});
    ranges.push_back({middle, range.end});
    ranges.erase(ranges.begin() + static_cast<std::ptrdiff_t>(r));
    --r;
  }
  for (const Range& range : ranges) {
    Bounds bounds;
    for (std::size_t i = range.begin; i < range.end; ++i)
      for (const vec3& p : triangles[i].p) bounds.add(p);
    Sphere sphere{bounds.centre(), 0.0F};
    for (std::size_t i = range.begin; i < range.end; ++i)
      for (const vec3& p : triangles[i].p) sphere.radius = std::max(sphere.radius, length(p - sphere.centre));
    sphere.radius *= 1.0001F;
    clusters.push_back(sphere);
  }
  return clusters;
}

std::vector<std::unique_ptr<Emitter>> makeEmitters(const TraceScene& scene, const MaterialTable& materials,
                                                   const LightSet& lights, const EmissionTargets& targets) {
  std::vector<std::unique_ptr<Emitter>> emitters;
  if (targets.empty()) return emitters;
  for (std::uint32_t i = 0; i < scene.scene().lights.size(); ++i) {
    const Light& light = scene.scene().lights[i];
    std::unique_ptr<Emitter> emitter;
    if (light.kind == LightKind::kSun) {
      emitter = std::make_unique<SunEmitter>(scene, light, targets);
    } else {
      emitter = std::make_unique<PointEmitter>(light, targets);
      emitter->interior_ = findInterior(scene, light.position);
    }
    emitter->source_ = i;
    if (luminance(emitter->expectedFlux()) > 0.0F) emitters.push_back(std::move(emitter));
  }
  const auto addPiloted = [&](std::unique_ptr<Emitter> emitter, std::uint32_t source) {
    emitter->source_ = source;
    emitter->expected_flux_ = runPilot(*emitter);
    if (luminance(emitter->expectedFlux()) > 0.0F) emitters.push_back(std::move(emitter));
  };
  for (std::size_t i = 0; i < lights.meshLights().size(); ++i) {
    const LightSet::MeshLight& light = lights.meshLights()[i];
    auto emitter = std::make_unique<MeshEmitter>(scene, materials, light, targets);
    vec3 p[3];
    scene.triangleCorners(light.instance, 0, p);
    const vec3 normal = normalize(cross(p[1] - p[0], p[2] - p[0]));
    const vec3 middle = (p[0] + p[1] + p[2]) * (1.0F / 3.0F);
    emitter->interior_ = findInterior(scene, middle + normal * (1e-5F * scene.bounds().radius()));
    addPiloted(std::move(emitter), lights.sourceOfMesh(i));
  }
  if (lights.environment())
    addPiloted(std::make_unique<EnvironmentEmitter>(scene, *lights.environment(), targets),
               lights.sourceOfEnvironment());
  return emitters;
}

InteriorList findInterior(const TraceScene& scene, vec3 position) {
  // Upward, for open water above; tilted by odd amounts, so that it runs along no modelled face or edge.
  const vec3 dir = normalize(vec3(0.01237F, 1.0F, 0.02571F));
  std::vector<std::uint32_t> left, entered;  // instances
  Ray ray{position, dir};
  RayHit hit;
  for (int i = 0; i < 256 && scene.intersect(ray, hit); ++i) {
    const SurfacePoint point = scene.surfaceAt(ray, hit);
    if (scene.materialOf(hit.instance).isSolidDielectric()) {
      const std::uint32_t solid = scene.solidOf(hit.instance);
      if (dot(dir, point.normal_geometric) < 0.0F) {
        entered.push_back(solid);
      } else if (const auto at = std::find(entered.begin(), entered.end(), solid); at != entered.end()) {
        entered.erase(at);
      } else {
        left.push_back(hit.instance);
      }
    }
    ray.origin = offsetOrigin(point, dir);
  }
  // The one left first is the innermost, that is the one entered last.
  InteriorList interior;
  for (auto i = left.rbegin(); i != left.rend(); ++i) {
    const std::uint32_t solid = scene.solidOf(*i);
    if (!interior.contains(solid)) interior.enter(solid, scene.materialOf(*i));
  }
  return interior;
}

}  // namespace nephroid
