#include "scene/import/gltf_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace nephroid::gltf {
namespace {

quat toQuat(vec4 v) { return {v.w, v.x, v.y, v.z}; }
vec4 toVec4(quat q) { return {q.x, q.y, q.z, q.w}; }

/// A zero quaternion names no rotation; it is read as none.
vec4 normalizeRotation(vec4 v) {
  const float length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : vec4(0, 0, 0, 1);
}

/// Cubic Hermite spline on [0, 1] with values p and tangents m at both ends.
vec4 interpolateHermite(vec4 p0, vec4 m0, vec4 p1, vec4 m1, float s) {
  const float s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * p0 + (s3 - 2 * s2 + s) * m0 + (3 * s2 - 2 * s3) * p1 + (s3 - s2) * m1;
}

Interpolation readInterpolation(const Document& document, const std::string& name, const std::string& place) {
  if (name == "LINEAR" || name.empty()) return Interpolation::kLinear;
  if (name == "STEP") return Interpolation::kStep;
  if (name == "CUBICSPLINE") return Interpolation::kCubicSpline;
  document.fail(place, fmt::format("interpolation '{}' is unknown", cleanName(name)));
}

void checkTimes(const Document& document, const std::vector<float>& times, const std::string& place) {
  for (std::size_t i = 0; i < times.size(); ++i)
    if (!std::isfinite(times[i]) || times[i] < 0 || (i > 0 && times[i] < times[i - 1]))
      document.fail(place,
                    fmt::format("time {} at key {} is negative, not finite or before its predecessor", times[i], i));
}

Curve readCurve(Document& document, AccessorReader& reader, const tinygltf::AnimationSampler& sampler, bool is_rotation,
                const std::string& place) {
  Curve curve;
  curve.interpolation = readInterpolation(document, sampler.interpolation, place);
  curve.is_rotation = is_rotation;
  curve.times = reader.readFloats(sampler.input, 1, place + ".input");
  checkTimes(document, curve.times, place + ".input");
  if (is_rotation)
    curve.values = reader.readVec4(sampler.output, place + ".output");
  else
    for (const vec3& value : reader.readVec3(sampler.output, place + ".output")) curve.values.emplace_back(value, 0.0F);
  const std::size_t per_key = curve.interpolation == Interpolation::kCubicSpline ? 3 : 1;
  if (curve.values.size() != per_key * curve.times.size())
    document.fail(place, fmt::format("{} values for {} keys, expected {}", curve.values.size(), curve.times.size(),
                                     per_key * curve.times.size()));
  return curve;
}

/// Writes the curve's value to the node. @return false if the path is none of translation, rotation, scale
bool isTransformPath(const std::string& path) { return path == "translation" || path == "rotation" || path == "scale"; }

void apply(const std::string& path, vec4 value, LocalTransform& local) {
  if (path == "translation") local.translation = vec3(value);
  if (path == "rotation") local.rotation = toQuat(value);
  if (path == "scale") local.scale = vec3(value);
}

}  // namespace

mat4 LocalTransform::toMatrix() const {
  if (matrix) return *matrix;
  mat4 m = glm::mat4_cast(rotation);
  for (int c = 0; c < 3; ++c) m[c] *= scale[c];
  m[3] = vec4(translation, 1.0F);
  return m;
}

vec4 sampleCurve(const Curve& curve, float time) {
  const bool is_cubic = curve.interpolation == Interpolation::kCubicSpline;
  const auto valueAt = [&](std::size_t key) { return curve.values[is_cubic ? 3 * key + 1 : key]; };
  const auto finish = [&](vec4 value) { return curve.is_rotation ? normalizeRotation(value) : value; };
  const auto after = std::upper_bound(curve.times.begin(), curve.times.end(), time);
  if (after == curve.times.begin()) return finish(valueAt(0));
  const auto key = static_cast<std::size_t>(after - curve.times.begin()) - 1;
  if (after == curve.times.end() || curve.interpolation == Interpolation::kStep) return finish(valueAt(key));
  const float interval = curve.times[key + 1] - curve.times[key];
  const float s = (time - curve.times[key]) / interval;
  if (is_cubic)
    return finish(interpolateHermite(valueAt(key), interval * curve.values[3 * key + 2], valueAt(key + 1),
                                     interval * curve.values[3 * key + 3], s));
  if (!curve.is_rotation) return (1 - s) * valueAt(key) + s * valueAt(key + 1);
  const quat from = toQuat(normalizeRotation(valueAt(key))), to = toQuat(normalizeRotation(valueAt(key + 1)));
  return finish(toVec4(glm::slerp(from, to, s)));
}

float animateNodes(Document& document, AccessorReader& reader, float time, std::vector<LocalTransform>& locals) {
  float duration = 0.0F;
  std::set<std::pair<int, std::string>> moved;
  for (std::size_t a = 0; a < document.model.animations.size(); ++a) {
    const tinygltf::Animation& animation = document.model.animations[a];
    const std::string place = placeOf("animations", a, animation.name);
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      if (channel.target_node < 0) continue;  // glTF: a channel without a node is to be ignored
      if (static_cast<std::size_t>(channel.target_node) >= locals.size())
        document.fail(place, fmt::format("moves node {}, the file has {}", channel.target_node, locals.size()));
      if (!isTransformPath(channel.target_path)) {
        document.warn(place, fmt::format("'{}' is not animated", cleanName(channel.target_path)));
        continue;
      }
      if (channel.sampler < 0 || static_cast<std::size_t>(channel.sampler) >= animation.samplers.size())
        document.fail(place, fmt::format("refers to sampler {} of {}", channel.sampler, animation.samplers.size()));
      LocalTransform& local = locals[static_cast<std::size_t>(channel.target_node)];
      if (local.matrix) {
        document.warn(place, fmt::format("moves node {}, which has a matrix; ignored", channel.target_node));
        continue;
      }
      if (!moved.emplace(channel.target_node, channel.target_path).second) {
        document.warn(place, fmt::format("moves the {} of node {} again; the first animation is shown",
                                         channel.target_path, channel.target_node));
        continue;
      }
      const auto sampler = static_cast<std::size_t>(channel.sampler);
      const Curve curve = readCurve(document, reader, animation.samplers[sampler], channel.target_path == "rotation",
                                    place + "." + placeOf("samplers", sampler));
      apply(channel.target_path, sampleCurve(curve, time), local);
      duration = std::max(duration, curve.times.back());
    }
  }
  return duration;
}

}  // namespace nephroid::gltf
