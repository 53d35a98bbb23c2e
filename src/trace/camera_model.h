// The camera as both directions of transport need it: rays through pixels, and pixels for points.
#pragma once

#include <cmath>
#include <optional>

#include "core/math.h"
#include "scene/scene_data.h"
#include "trace/trace_scene.h"

namespace nephroid {

/// A point as the camera sees it.
struct CameraConnection {
  int x, y;        ///< pixel
  vec2 film;       ///< the same as a place, in pixels
  vec3 dir;        ///< unit, from the point to the camera
  float distance;  ///< m, to the eye, or to the picture plane of an orthographic camera
  /// What turns flux·BSDF at the point into the pixel's mean radiance, but for the cosine at the point, 1/m²:
  /// perspective 1/(d² A cos³θ), with A the pixel's area on the plane at distance 1; orthographic 1/A, A in m².
  float importance;
};

class CameraModel {
 public:
  CameraModel(const Camera& camera, int width, int height)
      : eye_(camera.eye),
        forward_(camera.forward),
        up_(camera.up),
        right_(cross(camera.forward, camera.up)),
        width_(width),
        height_(height),
        orthographic_(camera.ortho_height > 0.0F) {
    half_height_ = orthographic_ ? 0.5F * camera.ortho_height : std::tan(0.5F * camera.fov_y);
    half_width_ = half_height_ * static_cast<float>(width) / static_cast<float>(height);
    const float pixel = 2.0F * half_height_ / static_cast<float>(height);
    pixel_area_ = pixel * pixel;
  }

  /// @param film  in pixels, (0, 0) the upper left corner of the picture
  Ray rayThrough(vec2 film) const {
    const float x = (2.0F * film.x / static_cast<float>(width_) - 1.0F) * half_width_;
    const float y = (1.0F - 2.0F * film.y / static_cast<float>(height_)) * half_height_;
    if (orthographic_) return {eye_ + x * right_ + y * up_, forward_};
    return {eye_, normalize(forward_ + x * right_ + y * up_)};
  }

  /// Nothing if the point is behind the camera or outside the picture.
  std::optional<CameraConnection> connect(vec3 position) const {
    const vec3 from_eye = position - eye_;
    const float depth = dot(from_eye, forward_);
    if (!(depth > 0.0F)) return std::nullopt;
    const float scale = orthographic_ ? 1.0F : 1.0F / depth;
    const float fx = (dot(from_eye, right_) * scale / half_width_ + 1.0F) * 0.5F * static_cast<float>(width_);
    const float fy = (1.0F - dot(from_eye, up_) * scale / half_height_) * 0.5F * static_cast<float>(height_);
    if (!(fx >= 0.0F && fy >= 0.0F && fx < static_cast<float>(width_) && fy < static_cast<float>(height_)))
      return std::nullopt;
    CameraConnection c;
    c.x = static_cast<int>(fx), c.y = static_cast<int>(fy);
    c.film = vec2(fx, fy);
    if (orthographic_) {
      c.dir = -forward_;
      c.distance = depth;
      c.importance = importanceAt(position);
      return c;
    }
    c.distance = length(from_eye);
    c.dir = from_eye / -c.distance;
    c.importance = importanceAt(position);
    return c;
  }
  /// CameraConnection::importance of a point before the camera: pixels per area perpendicular to the ray, 1/m².
  float importanceAt(vec3 position) const {
    if (orthographic_) return 1.0F / pixel_area_;
    const vec3 from_eye = position - eye_;
    const float distance = length(from_eye), cos_theta = dot(from_eye, forward_) / distance;
    return 1.0F / (distance * distance * pixel_area_ * cos_theta * cos_theta * cos_theta);
  }

  /// How a point that the camera sees moves over the film, in pixels, when it moves by `offset`, to first order.
  vec2 filmOffset(vec3 position, vec3 offset) const {
    const vec2 pixels_per_unit =
        vec2(0.5F * static_cast<float>(width_) / half_width_, -0.5F * static_cast<float>(height_) / half_height_);
    const vec2 across(dot(offset, right_), dot(offset, up_));
    if (orthographic_) return pixels_per_unit * across;
    const vec3 from_eye = position - eye_;
    const float depth = dot(from_eye, forward_), deeper = dot(offset, forward_) / depth;
    return pixels_per_unit * (across - deeper * vec2(dot(from_eye, right_), dot(from_eye, up_))) / depth;
  }

  float depthOf(vec3 position) const { return dot(position - eye_, forward_); }
  vec3 eye() const { return eye_; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  vec3 eye_, forward_, up_, right_;
  int width_, height_;
  bool orthographic_;
  float half_height_, half_width_, pixel_area_;
};

}  // namespace nephroid
