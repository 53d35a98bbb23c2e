// Vectors, matrices and the few helpers that every layer needs. GLM's types under our names.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace nephroid {

using glm::cross;
using glm::dot;
using glm::length;
using glm::mat3;
using glm::mat4;
using glm::normalize;
using glm::quat;
using glm::uvec2;
using glm::uvec3;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using dvec2 = glm::dvec2;
using dvec3 = glm::dvec3;

inline constexpr float kPi = 3.14159265358979323846F;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// The largest float below one: samples in [0, 1) are clamped to it.
inline constexpr float kOneMinusEpsilon = 0x1.fffffep-1F;

inline constexpr float radians(float angle_deg) { return angle_deg * (kPi / 180.0F); }
inline constexpr float degrees(float angle) { return angle * (180.0F / kPi); }

/// Relative luminance of linear Rec. 709 RGB.
inline float luminance(vec3 rgb) { return 0.2126F * rgb.x + 0.7152F * rgb.y + 0.0722F * rgb.z; }

inline float maxComponent(vec3 v) { return std::max(v.x, std::max(v.y, v.z)); }
inline float minComponent(vec3 v) { return std::min(v.x, std::min(v.y, v.z)); }
inline bool isFinite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// A point of an affine map, no perspective divide.
inline vec3 transformPoint(const mat4& m, vec3 p) { return vec3(m * vec4(p, 1.0F)); }
/// A direction of an affine map; its length changes with the map's scale.
inline vec3 transformVector(const mat4& m, vec3 v) { return vec3(m * vec4(v, 0.0F)); }

/// Right-handed orthonormal basis whose third axis is `z`.
struct Frame {
  vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

  /// @param z unit vector. Branch-free construction, continuous but for the sign of z.z (Duff et al. 2017).
  static Frame fromZ(vec3 z) {
    const float sign = std::copysign(1.0F, z.z);
    const float a = -1.0F / (sign + z.z);
    const float b = z.x * z.y * a;
    return {vec3(1.0F + sign * z.x * z.x * a, sign * b, -sign * z.x), vec3(b, sign + z.y * z.y * a, -z.y), z};
  }
  vec3 toWorld(vec3 v) const { return v.x * x + v.y * y + v.z * z; }
  vec3 toLocal(vec3 v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
};

/// Axis-aligned box; empty until something is added.
struct Bounds {
  vec3 lower{kInfinity}, upper{-kInfinity};

  bool empty() const { return !(lower.x <= upper.x); }
  void add(vec3 p) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  void add(const Bounds& b) {
    if (b.empty()) return;
    add(b.lower);
    add(b.upper);
  }
  vec3 centre() const { return 0.5F * (lower + upper); }
  vec3 extent() const { return empty() ? vec3(0) : upper - lower; }
  /// Radius of the sphere about `centre()` that holds the box; 0 if empty.
  float radius() const { return empty() ? 0.0F : 0.5F * length(upper - lower); }
};

}  // namespace nephroid
