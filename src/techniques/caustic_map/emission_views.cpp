#include "techniques/caustic_map/emission_views.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/math.h"
#include "frame/view.h"

namespace nephroid {
namespace {

/// A point's view is fitted up to this tangent of the half-angle of the generators; farther out a perspective picture
/// wastes its cells on the corners, and faces of a cube take over.
constexpr double kWidestTangent = 1.5;
/// A frustum is wider by so much than what it holds: rounding must not leave out an edge.
constexpr double kFitMargin = 1.0 + 1e-4;
/// Angles over a quarter turn that are tried; between the best one's neighbours the search goes on by thirds.
constexpr int kTurns = 16;
constexpr int kThirds = 14;
/// A view is turned only if that leaves at most so much of its size: on a ball, where no angle is the best and that of
/// its outline a matter of chance, cells would swirl when the light moves.
constexpr double kWorthTurning = 0.95;
/// Steps to find the plane through the light that touches the generators. Each comes closer than the square of the one
/// before; three or four do.
constexpr int kSteps = 32;
/// Times that a frustum is pointed at the middle of what it holds: each leaves a small share of the angle.
constexpr int kCentrings = 4;

/// Turned about its z.
Frame turned(const Frame& frame, double angle) {
  const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
  return {normalize(c * frame.x + s * frame.y), normalize(c * frame.y - s * frame.x), frame.z};
}

/// The angle at which `size`, a function of it with the period of a quarter turn, is smallest, or 0 if that is little
/// better.
template <class Size>
double bestTurn(const Size& size) {
  constexpr double kStep = 0.5 * kPi / kTurns;
  const double unturned = size(0.0);
  double best = 0.0, least = unturned;
  for (int i = 1; i < kTurns; ++i)
    if (const double here = size(kStep * i); here < least) best = kStep * i, least = here;
  double from = best - kStep, to = best + kStep;
  for (int i = 0; i < kThirds; ++i) {
    const double third = (to - from) / 3.0;
    const bool is_nearer = size(from + third) < size(to - third);
    (is_nearer ? to : from) += is_nearer ? -third : third;
  }
  best = 0.5 * (from + to);
  return size(best) < kWorthTurning * unturned ? best : 0.0;
}

/// Of the generators, in the coordinates of a frame; its z is left at 0.
Bounds sidesOf(const GeneratorHull& generators, const Frame& frame) {
  const auto reach = [&](vec3 axis) { return static_cast<float>(dot(generators.farthest(dvec3(axis)), dvec3(axis))); };
  return {vec3(-reach(-frame.x), -reach(-frame.y), 0.0F), vec3(reach(frame.x), reach(frame.y), 0.0F)};
}

ViewRecord fitParallelView(vec3 direction, const GeneratorHull& generators, const Bounds& scene) {
  const Frame frame = Frame::fromZ(direction);
  const GeneratorHull& outline = generators.outline();
  const double angle = bestTurn([&](double turn) {
    const vec3 extent = sidesOf(outline, turned(frame, turn)).extent();
    return double{extent.x} * extent.y;
  });
  const Frame best = turned(frame, angle);
  return makeParallelView(best, sidesOf(generators, best), scene);
}

/// Slopes, over the distance along a frame's z, between which the generators are as seen from a point.
struct Slopes {
  dvec2 lower, upper;
  /// Of the angles.
  dvec2 middle() const { return tan(0.5 * (atan(lower) + atan(upper))); }
  double area() const { return (upper.x - lower.x) * (upper.y - lower.y); }
};

/// Frustums about generators, as a point sees them.
class FrustumFit {
 public:
  FrustumFit(const GeneratorHull& generators, vec3 eye) : generators_(generators), eye_(eye) {}

  /// @return  nothing if they are farther out on some side than a frustum should be, or behind the eye
  std::optional<Slopes> slopes(const Frame& frame) const {
    const dvec3 x(frame.x), y(frame.y), z(frame.z);
    if (!(dot(generators_.farthest(-z) - eye_, z) > 0.0)) return std::nullopt;
    const Slopes s{{-slope(-x, z), -slope(-y, z)}, {slope(x, z), slope(y, z)}};
    const dvec2 widest = glm::max(-s.lower, s.upper);
    return std::max(widest.x, widest.y) <= kWidestTangent ? std::optional(s) : std::nullopt;
  }

  /// Pointed at their middle, its sides as they were.
  Frame centred(Frame frame) const {
    for (int i = 0; i < kCentrings; ++i) {
      const std::optional<Slopes> s = slopes(frame);
      if (!s) break;
      const vec2 middle(s->middle());
      frame.z = normalize(frame.z + middle.x * frame.x + middle.y * frame.y);
      frame.x = normalize(frame.x - dot(frame.x, frame.z) * frame.z);
      frame.y = cross(frame.z, frame.x);
    }
    return frame;
  }

 private:
  /// The largest ratio of (p − eye)·axis to (p − eye)·forward of all points p, all before the eye. Where it is t, no
  /// point is beyond the plane of axis − t·forward; the point that is the farthest beyond that of a smaller t has a
  /// larger ratio (Dinkelbach's method, which ends after finitely many steps).
  double slope(const dvec3& axis, const dvec3& forward) const {
    const auto ratioOf = [&](const dvec3& p) { return dot(p - eye_, axis) / dot(p - eye_, forward); };
    double ratio = ratioOf(generators_.farthest(axis));
    for (int i = 0; i < kSteps; ++i) {
      const double next = ratioOf(generators_.farthest(axis - ratio * forward));
      if (!(next > ratio)) break;
      ratio = next;
    }
    return ratio;
  }

  const GeneratorHull& generators_;
  dvec3 eye_;
};

std::optional<ViewRecord> fitFrustum(vec3 eye, const GeneratorHull& generators, const Bounds& scene) {
  const vec3 to = generators.bounds().centre() - eye;
  if (!(length(to) > 0.0F)) return std::nullopt;
  const FrustumFit rough(generators.outline(), eye), fit(generators, eye);
  Frame frame = rough.centred(Frame::fromZ(normalize(to)));
  if (!rough.slopes(frame)) return std::nullopt;
  const double angle = bestTurn([&](double turn) {
    const std::optional<Slopes> slopes = rough.slopes(turned(frame, turn));
    return slopes ? slopes->area() : static_cast<double>(kInfinity);
  });
  frame = fit.centred(turned(frame, angle));
  const std::optional<Slopes> slopes = fit.slopes(frame);
  if (!slopes) return std::nullopt;
  const dvec2 tangents = kFitMargin * glm::max(-slopes->lower, slopes->upper);
  // What is seen edge-on has no width; a sliver keeps the projection regular.
  const dvec2 least(kFitMargin - 1.0);
  const DepthRange range = fitDepthRange(scene, eye, frame.z);
  return makePerspectiveView(eye, frame.z, frame.y, vec2(glm::max(tangents, least * std::max(tangents.x, tangents.y))),
                             range);
}

/// False only if none of them is inside the pyramid of a cube's face.
bool mayShow(const ViewRecord& face, const GeneratorHull& generators) {
  const dvec3 forward(face.forward), right(face.right), up(face.up), eye(face.eye);
  // Points that the face shows lie on the positive side of each of these.
  for (const dvec3& inward : {forward, forward + right, forward - right, forward + up, forward - up})
    if (dot(generators.farthest(inward) - eye, inward) < 0.0) return false;
  return true;
}

/// Can a spot's cone reach a box? Conservative: by the sphere about it.
bool reaches(const LightRecord& light, const Bounds& box) {
  if (light.kind != kLightSpot) return true;
  const vec3 to = box.centre() - light.position;
  const float distance = length(to), radius = box.radius();
  if (distance <= radius) return true;
  const float angle = std::acos(std::clamp(dot(to, light.direction) / distance, -1.0F, 1.0F));
  return angle - std::asin(radius / distance) <= std::acos(std::clamp(light.cos_outer, -1.0F, 1.0F));
}

}  // namespace

std::vector<ViewRecord> makeEmissionViews(const LightRecord& light, const GeneratorHull& generators,
                                          const Bounds& scene) {
  if (light.kind == kLightDirectional) return {fitParallelView(light.direction, generators, scene)};
  if (!reaches(light, generators.bounds())) return {};
  if (const std::optional<ViewRecord> view = fitFrustum(light.position, generators, scene)) return {*view};
  std::vector<ViewRecord> views;
  for (int face = 0; face < 6; ++face) {
    const ViewRecord view = makeCubeView(light.position, face, scene);
    if (mayShow(view, generators)) views.push_back(view);
  }
  return views;
}

}  // namespace nephroid
