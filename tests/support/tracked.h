// Numbers that carry how far a graphics device may be from the CPU.
//
// A tolerance for a formula follows from the precision of its operations, but by hand that is a page of algebra for
// each function, and one that a changed formula leaves behind. Here the formula does it itself: the text of a shared
// header, compiled once more with Number for float (tracked_begin.h), gives the same values as with float and, beside
// each, a bound of |device − CPU| for these inputs: Vulkan's error of every operation, and the errors of its operands
// as they come through it (running error analysis; Higham, Accuracy and Stability of Numerical Algorithms, §3.3).
//
// The errors are those of "Precision and Operation of SPIR-V Instructions" in Vulkan's specification:
//
//   + − ×            correctly rounded, in either direction: 1 ulp
//   /                2.5 ulp
//   inversesqrt      2 ulp; sqrt inherits from 1/inversesqrt: 4.5 ulp
//   length, normalize, dot, cross, mix   inherit from their formulas
//   exp              (3 + 2|x|) ulp
//   log              3 ulp outside [0.5, 2], 2⁻²¹ absolute inside
//   sin, cos         2⁻¹¹ absolute within [−π, π]; outside nothing is promised, so the bound is infinite
//   atan(y, x)       4096 ulp
//   min, max, clamp, abs, floor   exact
//   results and operands below 2⁻¹²⁶ may be flushed to zero
//
// to which half an ulp of the CPU is added, one for its exp, log, sin, cos, atan. A comparison whose outcome the errors
// leave open, a rounding to an integer likewise, is a fork: the device may go either way, and every way is evaluated.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace nephroid::tracked {

/// The forks on the way through one evaluation. Not thread-safe, as tests are not.
class Forks {
 public:
  /// A kind of decision and what it is about: the same question has the same answer all along a path.
  using Question = std::array<double, 5>;

  /// @return `natural`, what the CPU does, or its opposite where that is open and this path takes it
  static bool decide(bool natural, bool open, const Question& question) {
    if (!open) return natural;
    const auto asked = std::find(asked_.begin(), asked_.end(), question);
    const auto turn = static_cast<std::size_t>(asked - asked_.begin());
    if (asked == asked_.end()) asked_.push_back(question);
    if (turn == turns_.size()) turns_.push_back(false);
    return natural != turns_[turn];
  }
  /// From here on this path's integers may be anything: so far off is what they were rounded from.
  static void loseIntegers() { integers_lost_ = true; }
  static bool integersLost() { return integers_lost_; }

  /// Calls visit(path) for each combination of turns, the CPU's own first, up to `limit`.
  /// @return whether there were no more
  template <class Visit>
  static bool forEachPath(std::size_t limit, Visit&& visit) {
    turns_.clear();
    for (std::size_t path = 0; path < limit; ++path) {
      asked_.clear();
      integers_lost_ = false;
      visit(path);
      // As counting in binary, but a turn taken differently may lead to other forks, so those after it are forgotten.
      turns_.resize(asked_.size());
      while (!turns_.empty() && turns_.back()) turns_.pop_back();
      if (turns_.empty()) return true;
      turns_.back() = true;
    }
    return false;
  }

 private:
  static inline std::vector<bool> turns_;
  static inline std::vector<Question> asked_;
  static inline bool integers_lost_ = false;
};

struct Number {
  float value = 0;
  double error = 0;  ///< bound of |device − CPU|; infinite: none is known

  constexpr Number() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): literals of the shared text become numbers
  constexpr Number(float v)
      : value(v), error(v > -kSmallestNormal && v < kSmallestNormal ? static_cast<double>(v < 0 ? -v : v) : 0.0) {}
  constexpr Number(float v, double e) : value(v), error(e) {}
  explicit operator std::uint32_t() const { return static_cast<std::uint32_t>(value); }

  static constexpr float kSmallestNormal = std::numeric_limits<float>::min();
};

inline constexpr double kUlp = std::numeric_limits<float>::epsilon();
inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// Error of an operation's result: what comes from its operands, and `ulps` of its own.
inline Number withError(float value, double inherited, double ulps) {
  if (std::isnan(inherited)) inherited = kUnbounded;
  if (!std::isfinite(value)) return {value, inherited == kUnbounded ? kUnbounded : 0.0};
  const double size = std::abs(static_cast<double>(value));
  double error = inherited + ulps * kUlp * (size + inherited);
  const bool is_zero = size == 0 && inherited == 0 && ulps == 0;
  if (!is_zero && size - inherited < Number::kSmallestNormal) error += Number::kSmallestNormal;
  return {value, error};
}

/// Factor times error, where either being zero wins over the other being infinite.
inline double scaleError(double factor, double error) {
  return factor == 0 || error == 0 ? 0.0 : std::abs(factor) * error;
}

inline Number operator-(Number a) { return {-a.value, a.error}; }
inline Number operator+(Number a, Number b) {
  const double x = a.value, y = b.value, sum = x + y, back = sum - x;
  const float value = a.value + b.value;
  // Knuth's TwoSum: an exact sum of exact numbers is exact on every device.
  const bool exact = a.error + b.error == 0 && (x - (sum - back)) + (y - back) == 0 && sum == value;
  return withError(value, a.error + b.error, exact ? 0.0 : 1.5);
}
inline Number operator-(Number a, Number b) { return a + -b; }
inline bool isZero(Number x) { return x.value == 0 && x.error == 0; }
inline Number operator*(Number a, Number b) {
  const float value = a.value * b.value;
  if ((isZero(a) || isZero(b)) && value == 0) return {value, 0.0};
  const bool exact = a.error + b.error == 0 && static_cast<double>(a.value) * b.value == value;
  return withError(value, scaleError(a.value, b.error) + scaleError(b.value, a.error) + scaleError(a.error, b.error),
                   exact ? 0.0 : 1.5);
}
inline Number operator/(Number a, Number b) {
  const float value = a.value / b.value;
  const double size = std::abs(static_cast<double>(b.value));
  if (b.error > 0 && size <= b.error) return {value, kUnbounded};
  // Vulkan promises nothing here; that a number over 0 is infinite is what every device does.
  if (size == 0) return {value, std::abs(static_cast<double>(a.value)) > a.error ? 0.0 : kUnbounded};
  if (isZero(a)) return {value, 0.0};
  return withError(value, (a.error + scaleError(value, b.error)) / (size - b.error), 3.0);
}

inline bool open(Number a, Number b) {
  const double slack = a.error + b.error;
  return slack > 0 && std::abs(static_cast<double>(a.value) - b.value) <= slack;
}
inline bool operator<(Number a, Number b) {
  return Forks::decide(a.value < b.value, open(a, b), {0, a.value, a.error, b.value, b.error});
}
inline bool operator>(Number a, Number b) {
  return Forks::decide(a.value > b.value, open(a, b), {1, a.value, a.error, b.value, b.error});
}
inline bool operator<=(Number a, Number b) {
  return Forks::decide(a.value <= b.value, open(a, b), {2, a.value, a.error, b.value, b.error});
}
inline bool operator>=(Number a, Number b) {
  return Forks::decide(a.value >= b.value, open(a, b), {3, a.value, a.error, b.value, b.error});
}
inline bool operator==(Number a, Number b) {
  return Forks::decide(a.value == b.value, open(a, b), {4, a.value, a.error, b.value, b.error});
}

inline Number abs(Number x) { return {std::abs(x.value), x.error}; }
inline Number min(Number a, Number b) {
  const Number& smaller = b.value < a.value ? b : a;
  return {smaller.value, open(a, b) ? std::max(a.error, b.error) : smaller.error};
}
inline Number max(Number a, Number b) { return -min(-a, -b); }
inline Number clamp(Number x, Number low, Number high) { return min(max(x, low), high); }
inline Number mix(Number a, Number b, Number t) { return a * (Number(1.0F) - t) + b * t; }

/// A whole number next to x by `round`: each that the error reaches, if they are few.
template <class Round>
Number toWhole(Number x, const Round& round) {
  constexpr double kFew = 8;
  const double low = round(x.value - x.error), high = round(x.value + x.error);
  const double natural = round(static_cast<double>(x.value));
  if (!(high - low <= kFew)) return {static_cast<float>(natural), low == high ? 0.0 : high - low};
  for (double other = low; other <= high; ++other)
    if (other != natural && !Forks::decide(true, true, {5, x.value, x.error, other, 0}))
      return {static_cast<float>(other), 0.0};
  return {static_cast<float>(natural), 0.0};
}
inline Number floor(Number x) {
  return toWhole(x, [](double v) { return std::floor(v); });
}

/// A radicand that a fork has made negative is one that the device found positive: within the error above zero.
inline Number sqrt(Number x) {
  if (isZero(x)) return {x.value, 0.0};
  const float value = std::sqrt(x.value < 0 && x.value + x.error >= 0 ? 0.0F : x.value);
  const double v = x.value;
  const double down = v > x.error ? x.error / (std::sqrt(v) + std::sqrt(v - x.error)) : static_cast<double>(value);
  return withError(value, std::max(down, std::sqrt(std::max(v + x.error, 0.0)) - value), 5.0);
}
inline Number exp(Number x) {
  const float value = std::exp(x.value);
  return withError(value, scaleError(value, std::expm1(x.error)), 4.0 + 2.0 * std::abs(x.value));
}
inline Number log(Number x) {
  if (x.value <= x.error) return {std::log(x.value), x.error == 0 ? 0.0 : kUnbounded};
  const double inherited = -std::log1p(-x.error / x.value);
  const bool near_1 = x.value + x.error >= 0.5 && x.value - x.error <= 2.0;
  return withError(std::log(x.value), inherited + (near_1 ? std::ldexp(1.0, -21) : 0.0), 4.0);
}

/// As Vulkan defines it, by way of the logarithm.
inline Number pow(Number x, Number y) {
  if (isZero(x)) return {std::pow(x.value, y.value), 0.0};
  Number result = exp(y * log(x));
  result.value = std::pow(x.value, y.value);
  return result;
}

/// Of sin or cos: the precision ends at ±π, that is at π as a float, which is a little more.
inline Number ofAngle(Number x, float value) {
  const bool promised = std::abs(x.value) - x.error <= 3.141593;
  return withError(value, promised ? std::min(x.error + std::ldexp(1.0, -11), 2.0) : kUnbounded, 1.0);
}
inline Number sin(Number x) { return ofAngle(x, std::sin(x.value)); }
inline Number cos(Number x) { return ofAngle(x, std::cos(x.value)); }
inline Number atan(Number y, Number x) {
  constexpr double kPi = 3.14159265358979323846;
  const double length = std::hypot(x.value, y.value), error = std::hypot(x.error, y.error);
  float value = std::atan2(y.value, x.value);
  // Of the origin GLSL says that the angle is undefined.
  if (length <= error) return {value, 2.0 * kPi};
  // Across the negative axis the angle jumps, and the sign of a zero says nothing on a device.
  const bool at_jump = x.value < 0 && std::abs(y.value) <= y.error;
  if (!Forks::decide(true, at_jump, {6, x.value, x.error, y.value, y.error}))
    value = static_cast<float>(value > 0 ? value - 2.0 * kPi : value + 2.0 * kPi);
  return withError(value, std::asin(std::min(error / length, 1.0)), 4097.0);
}

struct vec2 {
  Number x, y;
  vec2() = default;
  vec2(Number a, Number b) : x(a), y(b) {}
  explicit vec2(Number a) : x(a), y(a) {}
};
struct vec3 {
  Number x, y, z;
  vec3() = default;
  vec3(Number a, Number b, Number c) : x(a), y(b), z(c) {}
  explicit vec3(Number a) : x(a), y(a), z(a) {}
};

inline vec2 operator-(vec2 a) { return {-a.x, -a.y}; }
inline vec2 operator+(vec2 a, vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline vec2 operator-(vec2 a, vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline vec2 operator*(vec2 a, Number s) { return {a.x * s, a.y * s}; }
inline vec2 operator*(Number s, vec2 a) { return {s * a.x, s * a.y}; }
inline vec2 operator/(vec2 a, Number s) { return {a.x / s, a.y / s}; }
inline vec3 operator-(vec3 a) { return {-a.x, -a.y, -a.z}; }
inline vec3 operator+(vec3 a, vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline vec3 operator-(vec3 a, vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline vec3 operator*(vec3 a, vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline vec3 operator*(vec3 a, Number s) { return {a.x * s, a.y * s, a.z * s}; }
inline vec3 operator*(Number s, vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline vec3 operator/(vec3 a, Number s) { return {a.x / s, a.y / s, a.z / s}; }
inline vec3 operator/(vec3 a, vec3 b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }
inline vec3& operator+=(vec3& a, vec3 b) { return a = a + b; }

inline Number dot(vec2 a, vec2 b) { return a.x * b.x + a.y * b.y; }
inline Number dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline vec3 cross(vec3 a, vec3 b) { return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y}; }
inline Number length(vec2 v) { return sqrt(dot(v, v)); }
inline Number length(vec3 v) { return sqrt(dot(v, v)); }
inline vec2 normalize(vec2 v) { return v * (Number(1.0F) / sqrt(dot(v, v))); }
inline vec3 normalize(vec3 v) { return v * (Number(1.0F) / sqrt(dot(v, v))); }

/// One half of packSnorm2x16; ties may be rounded either way.
inline std::uint32_t packSnorm16(Number x) {
  const Number scaled = clamp(x, -1.0F, 1.0F) * 32767.0F;
  const Number whole = toWhole(scaled, [](double v) { return std::round(v); });
  if (whole.error > 0) Forks::loseIntegers();
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(whole.value)) & 0xFFFFU;
}
inline std::uint32_t packSnorm2x16(vec2 v) { return packSnorm16(v.x) | (packSnorm16(v.y) << 16); }
inline Number unpackSnorm16(std::uint32_t bits) {
  // The product with 1/32767 is GLM's form of the quotient, which is what GLSL has.
  const float value = static_cast<float>(static_cast<std::int16_t>(bits & 0xFFFFU)) * 3.0518509475997192e-05F;
  const Number quotient = value == 0 ? Number(0.0F) : withError(value, 0.0, 4.0);
  return clamp({value, Forks::integersLost() ? 2.0 : quotient.error}, -1.0F, 1.0F);
}
inline vec2 unpackSnorm2x16(std::uint32_t bits) { return {unpackSnorm16(bits), unpackSnorm16(bits >> 16)}; }

}  // namespace nephroid::tracked
