#include "closed_form/hollow.h"

#include <utility>

#include "closed_form/optics.h"
#include "closed_form/profile.h"
#include "scene/builtin/shapes.h"

namespace nephroid::closed_form {
namespace {

/// Follows one ray, and what it splits into.
class HollowTracer {
 public:
  explicit HollowTracer(const HollowCase& c) : c_(c) {}

  /// Of the ray that falls along −y at x = −h, about a centre at the origin.
  HollowLandings trace(double h) {
    landings_.clear();
    const double a = c_.ball.radius;
    meet({dvec2(-h, std::sqrt(std::max(a * a - h * h, 0.0))), dvec2(0, -1), 1.0, 1}, false, false);
    return std::move(landings_);
  }

 private:
  static constexpr double kLeastShare = 1e-4;
  static constexpr int kMostInterfaces = 24;

  struct Ray {
    dvec2 place, dir;
    double share;
    std::uint64_t sequence;
    int interfaces = 0;
  };

  /// At an interface. @param is_cavity  of the two; @param inside  it comes from within that sphere
  void meet(const Ray& ray, bool is_cavity, bool inside) {
    if (ray.interfaces >= kMostInterfaces) return;
    const dvec2 out = normalize(ray.place), normal = inside ? -out : out;
    // Inside of the outer sphere there is glass, inside of the cavity air.
    const double from = inside != is_cavity ? c_.ball.ior : 1.0, to = inside != is_cavity ? 1.0 : c_.ball.ior;
    const double reflectance = fresnelReflectance(-dot(ray.dir, normal), from, to);
    const auto next = [&](dvec2 dir, double share, std::uint64_t mark) {
      return Ray{ray.place, dir, ray.share * share, ray.sequence << 2U | mark | (is_cavity ? 2U : 0U),
                 ray.interfaces + 1};
    };
    goOn(next(ray.dir - 2.0 * dot(ray.dir, normal) * normal, reflectance, 0), is_cavity, inside);
    if (const std::optional<dvec2> refracted = refract(ray.dir, normal, from, to))
      goOn(next(*refracted, 1.0 - reflectance, 1), is_cavity, !inside);
  }

  /// From an interface on. @param inside  of the sphere that it starts on
  void goOn(const Ray& ray, bool is_cavity, bool inside) {
    if (ray.share < kLeastShare) return;
    if (!is_cavity && !inside) return land(ray);
    if (is_cavity && inside) return meet(along(ray, c_.inner_radius, true), true, true);
    // In the glass, to the cavity if it is on the way.
    const double middle = -dot(ray.place, ray.dir), nearest = length(ray.place + middle * ray.dir);
    const bool meets_cavity = !is_cavity && middle > 0.0 && nearest < c_.inner_radius;
    if (meets_cavity) return meet(along(ray, c_.inner_radius, false), true, false);
    meet(along(ray, c_.ball.radius, true), false, true);
  }

  /// To where it meets a circle: its far side or the near one.
  static Ray along(Ray ray, double radius, bool far) {
    const double middle = -dot(ray.place, ray.dir), nearest = length(ray.place + middle * ray.dir);
    const double half = std::sqrt(std::max(radius * radius - nearest * nearest, 0.0));
    ray.place += (far ? middle + half : middle - half) * ray.dir;
    return ray;
  }

  void land(const Ray& ray) {
    if (ray.dir.y >= 0.0) return;
    const double drop = ray.place.y + c_.ball.radius + c_.ball.gap;
    landings_[ray.sequence] = {std::abs(ray.place.x - drop * ray.dir.x / ray.dir.y), ray.share};
  }

  HollowCase c_;
  HollowLandings landings_;
};

}  // namespace

HollowLandings traceHollow(const HollowCase& c, double h) { return HollowTracer(c).trace(h); }

std::vector<double> hollowIrradiance(const HollowCase& c, std::size_t bins) {
  constexpr int kRings = 60'000;
  Profile profile(0.0, c.ball.view_radius, bins);
  HollowTracer tracer(c);
  HollowLandings previous;
  for (int i = 0; i <= kRings; ++i) {
    HollowLandings here = tracer.trace(c.ball.radius * i / kRings);
    const double incident = 2.0 * kPiD * c.ball.radius * c.ball.radius * (i - 0.5) / kRings / kRings;
    for (const auto& [sequence, landing] : here) {
      const auto last = previous.find(sequence);
      if (last == previous.end()) continue;
      profile.deposit(last->second.radius, landing.radius, incident * 0.5 * (last->second.share + landing.share));
    }
    previous = std::move(here);
  }
  return profile.perAnnulus();
}

SceneData makeHollowScene(const HollowCase& c, int segments) {
  SceneData scene = makeBallScene(c.ball, segments);
  for (Mesh& mesh : scene.meshes) {
    if (mesh.name != "sphere") continue;
    // The cavity's normals point out of the glass, to the middle.
    const Mesh cavity = makeSphere("cavity", dvec3(0, c.ball.gap + c.ball.radius, 0), c.inner_radius, segments);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), cavity.positions.begin(), cavity.positions.end());
    for (const vec3& normal : cavity.normals) mesh.normals.push_back(-normal);
    for (const uvec3& t : cavity.triangles) mesh.triangles.push_back(uvec3(t.x, t.z, t.y) + first);
  }
  return scene;
}

}  // namespace nephroid::closed_form
