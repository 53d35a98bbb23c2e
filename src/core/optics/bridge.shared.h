// One vocabulary for C++ (GLM) and GLSL. Every *.shared.h includes this first and then reads as one language:
// no references, templates, default arguments or swizzles beyond .x .y .z; output through returned structs.
#ifndef NEPHROID_BRIDGE_SHARED_H
#define NEPHROID_BRIDGE_SHARED_H

#ifdef __cplusplus

#include <glm/glm.hpp>
#include <glm/packing.hpp>

#include <cmath>
#include <cstdint>

namespace nephroid {
using glm::mat3;
using glm::uvec3;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using std::uint32_t;
using uint = std::uint32_t;
using glm::abs;
using glm::clamp;
using glm::cos;
using glm::cross;
using glm::dot;
using glm::exp;
using glm::floor;
using glm::length;
using glm::log;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::packSnorm2x16;
using glm::pow;
using glm::sin;
using glm::sqrt;
using glm::unpackSnorm2x16;
/// GLSL's two-argument atan(y, x); a function of its own because glm::atan brings overloads that hide std::atan.
inline float atan(float y, float x) { return std::atan2(y, x); }
}  // namespace nephroid

#define NEPHROID_FN inline
#define NEPHROID_CONST inline constexpr
#define NEPHROID_NAMESPACE_BEGIN namespace nephroid {
#define NEPHROID_NAMESPACE_END }

#else

#define NEPHROID_FN
#define NEPHROID_CONST const
#define NEPHROID_NAMESPACE_BEGIN
#define NEPHROID_NAMESPACE_END
#define uint32_t uint

#endif
#endif
