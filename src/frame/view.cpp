#include "frame/view.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nephroid {
namespace {

/// Nearest that a view shows, relative to the farthest.
constexpr float kNearestShare = 1e-4F;

vec3 cornerOf(const Bounds& b, int corner) {
  return {(corner & 1) != 0 ? b.upper.x : b.lower.x, (corner & 2) != 0 ? b.upper.y : b.lower.y,
          (corner & 4) != 0 ? b.upper.z : b.lower.z};
}

/// Clip space from the parts of a view: x to the right, y down, z from w (near) to 0 (far).
void setClipRows(ViewRecord& view, const DepthRange& range, vec2 shift) {
  const vec3 x = view.right / dot(view.right, view.right), y = view.up / dot(view.up, view.up);
  const auto plane = [&](vec3 axis) { return vec4(axis, -dot(axis, view.eye)); };
  const vec4 depth = plane(view.forward);
  // Reversed: 1 at the near end, 0 at the far one. The digits that floats have near 0 make up for those that the
  // perspective division takes from what is far.
  const float span = range.far - range.near;
  const vec4 left = vec4(0, 0, 0, range.far) - depth;
  view.clip_row_w = view.is_orthographic != 0 ? vec4(0, 0, 0, 1) : depth;
  view.clip_row_z = left * ((view.is_orthographic != 0 ? 1.0F : range.near) / span);
  view.clip_row_x = plane(x) + shift.x * view.clip_row_w;
  view.clip_row_y = -plane(y) + shift.y * view.clip_row_w;
}

}  // namespace

DepthRange fitDepthRange(const Bounds& bounds, vec3 eye, vec3 forward) {
  if (bounds.empty()) return {0.5F, 1.0F};
  float nearest = kInfinity, farthest = 0.0F;
  for (int corner = 0; corner < 8; ++corner) {
    const vec3 p = cornerOf(bounds, corner);
    const float depth = dot(p - eye, forward);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  // Nothing is before the eye, or there is nothing at all: any range serves.
  if (!(farthest > 0.0F)) return {0.5F, 1.0F};
  farthest *= 1.001F;
  return {std::max(nearest * 0.999F, kNearestShare * farthest), farthest};
}

ViewRecord makeCameraView(const Camera& camera, int width, int height, const Bounds& bounds, vec2 film_offset) {
  ViewRecord view{};
  view.eye = camera.eye;
  view.forward = camera.forward;
  view.is_orthographic = camera.ortho_height > 0.0F ? 1 : 0;
  const float half_height = view.is_orthographic != 0 ? 0.5F * camera.ortho_height : std::tan(0.5F * camera.fov_y);
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  view.right = cross(camera.forward, camera.up) * (half_height * aspect);
  view.up = camera.up * half_height;
  // The rasteriser samples pixel centres: the sample's place is moved there.
  view.film_x = film_offset.x, view.film_y = film_offset.y;
  const vec2 shift = (vec2(0.5F) - film_offset) * 2.0F / vec2(static_cast<float>(width), static_cast<float>(height));
  setClipRows(view, fitDepthRange(bounds, camera.eye, camera.forward), shift);
  return view;
}

ViewRecord makePerspectiveView(vec3 eye, vec3 forward, vec3 up, vec2 half_tangents, const DepthRange& range) {
  ViewRecord view{};
  view.eye = eye;
  view.forward = forward;
  view.right = cross(forward, up) * half_tangents.x;
  view.up = up * half_tangents.y;
  view.film_x = view.film_y = 0.5F;
  setClipRows(view, range, vec2(0.0F));
  return view;
}

ViewRecord makeCubeView(vec3 eye, int face, const Bounds& bounds) {
  static constexpr std::array<vec3, 6> kForward{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
  const vec3 forward = kForward[static_cast<std::size_t>(face)];
  const vec3 up = face == 2 || face == 3 ? vec3(0, 0, 1) : vec3(0, 1, 0);
  return makePerspectiveView(eye, forward, up, vec2(1.0F), fitDepthRange(bounds, eye, forward));
}

namespace {

/// Where nothing is.
constexpr Bounds kOrigin{vec3(0.0F), vec3(0.0F)};

Bounds boundsAlong(const Frame& frame, const Bounds& bounds) {
  Bounds local;
  for (int corner = 0; corner < 8; ++corner) local.add(frame.toLocal(cornerOf(bounds, corner)));
  return local;
}

}  // namespace

ViewRecord makeParallelView(vec3 direction, const Bounds& bounds) {
  const Frame frame = Frame::fromZ(direction);
  return makeParallelView(frame, boundsAlong(frame, bounds.empty() ? kOrigin : bounds), bounds);
}

ViewRecord makeParallelView(const Frame& frame, const Bounds& sides, const Bounds& along) {
  const Bounds ends = boundsAlong(frame, along.empty() ? kOrigin : along);
  // A flat scene seen edge-on has no width; a sliver keeps the projection regular, and holds what rounding moves.
  const float sliver = 1e-6F * std::max(2.0F * ends.radius(), 1e-30F);
  const vec3 half = 0.5F * sides.extent() + glm::max(0.0005F * sides.extent(), vec3(sliver));
  const float half_depth = std::max(0.5F * ends.extent().z * 1.001F, sliver);
  ViewRecord view{};
  view.is_orthographic = 1;
  view.forward = frame.z;
  view.right = frame.x * half.x;
  view.up = frame.y * half.y;
  view.film_x = view.film_y = 0.5F;
  view.eye = frame.toWorld(vec3(sides.centre().x, sides.centre().y, ends.lower.z - half_depth));
  setClipRows(view, {0.0F, 4.0F * half_depth}, vec2(0.0F));
  return view;
}

ViewRecord makeParallelView(vec3 direction, vec3 right, vec3 up, vec3 centre, const Bounds& along) {
  // As far to both sides as the farthest corner may be.
  const float radius = std::max({length(along.centre() - centre) + along.radius(), length(right), length(up)});
  ViewRecord view{};
  view.is_orthographic = 1;
  view.forward = direction;
  view.right = right;
  view.up = up;
  view.film_x = view.film_y = 0.5F;
  view.eye = centre - 1.001F * radius * direction;
  setClipRows(view, {0.0F, 2.002F * radius}, vec2(0.0F));
  return view;
}

bool mayShow(const ViewRecord& view, const Bounds& bounds) {
  // Outside one of the planes with all corners: the near one and the four sides.
  std::array<bool, 5> outside{true, true, true, true, true};
  for (int corner = 0; corner < 8; ++corner) {
    const vec4 p(cornerOf(bounds, corner), 1.0F);
    const float x = dot(view.clip_row_x, p), y = dot(view.clip_row_y, p), w = dot(view.clip_row_w, p);
    const std::array<bool, 5> here{w <= 0.0F, x<-w, x> w, y<-w, y> w};
    for (std::size_t k = 0; k < here.size(); ++k) outside[k] = outside[k] && here[k];
  }
  return std::none_of(outside.begin(), outside.end(), [](bool b) { return b; });
}

}  // namespace nephroid
