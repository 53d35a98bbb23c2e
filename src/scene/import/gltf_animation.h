// Node animation: where every node is at a given time.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"
#include "scene/import/accessor_reader.h"

namespace nephroid::gltf {

/// A node's place relative to its parent: translation × rotation × scale, or a matrix, which cannot be animated.
struct LocalTransform {
  vec3 translation{0.0F};
  quat rotation{1, 0, 0, 0};
  vec3 scale{1.0F};
  std::optional<mat4> matrix;

  mat4 toMatrix() const;
};

enum class Interpolation { kStep, kLinear, kCubicSpline };

/// A keyframe curve of translations, scales (xyz used) or rotations (quaternion xyzw).
struct Curve {
  Interpolation interpolation = Interpolation::kLinear;
  bool is_rotation = false;
  std::vector<float> times;  ///< s, never decreasing, not empty
  std::vector<vec4> values;  ///< one per time; three for kCubicSpline: in-tangent, value, out-tangent
};

/// The curve at `time`; before its first and after its last key it keeps that key's value. Rotations are unit and take
/// the shorter way.
/// @see glTF 2.0, appendix C "Animation Sampler Interpolation Modes"; tangents are per second there and scaled by the
///      length of the interval here
vec4 sampleCurve(const Curve& curve, float time);

/// Applies all animations of the file at `time` seconds: exporters write one per object as often as one for all. Where
/// two move the same property of a node, the first wins and a warning says so.
/// @param locals  one per node; changed in place
/// @return        duration in seconds: the last key of all; 0 if nothing moves
/// @throws InputError
float animateNodes(Document& document, AccessorReader& reader, float time, std::vector<LocalTransform>& locals);

}  // namespace nephroid::gltf
