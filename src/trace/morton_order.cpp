#include "trace/morton_order.h"

#include <array>
#include <numeric>

namespace nephroid {
namespace {

/// Steps of the curve along each axis, as a power of two: cells about as many as the photons of a wave on a surface.
constexpr unsigned kBitsPerAxis = 9;
/// Bits of the key that one pass of the sort looks at.
constexpr unsigned kBitsPerPass = 9;
static_assert(3 * kBitsPerAxis <= 3 * kBitsPerPass);

/// The lower ten bits of x, two zeros between each two.
std::uint32_t spreadBits(std::uint32_t x) {
  x = (x | (x << 16)) & 0x030000FFU;
  x = (x | (x << 8)) & 0x0300F00FU;
  x = (x | (x << 4)) & 0x030C30C3U;
  return (x | (x << 2)) & 0x09249249U;
}

std::uint32_t clampStep(float x) {
  constexpr float kLast = static_cast<float>((1U << kBitsPerAxis) - 1);
  // Written so that what is not a number falls on 0.
  return x > 0.0F ? static_cast<std::uint32_t>(std::min(x, kLast)) : 0U;
}

}  // namespace

MortonOrder::MortonOrder(const Bounds& bounds)
    : centre_(bounds.centre()),
      steps_per_m_(static_cast<float>(1U << kBitsPerAxis) / std::max(2.0F * bounds.radius(), 1e-30F)) {}

std::uint32_t MortonOrder::keyOf(vec3 origin, vec3 dir) const {
  const vec3 from_centre = origin - centre_;
  return keyOfOffset(from_centre - dot(from_centre, dir) * dir);
}

std::uint32_t MortonOrder::keyOfOffset(vec3 from_centre) const {
  const vec3 step = from_centre * steps_per_m_ + static_cast<float>(1U << (kBitsPerAxis - 1));
  return spreadBits(clampStep(step.x)) | spreadBits(clampStep(step.y)) << 1 | spreadBits(clampStep(step.z)) << 2;
}

std::vector<std::uint32_t> MortonOrder::sort(std::span<const std::uint32_t> keys) {
  // Counting sort by the lowest third of the key, then, stable, by the others.
  std::vector<std::uint32_t> order(keys.size()), previous(keys.size());
  std::iota(order.begin(), order.end(), 0U);
  for (const unsigned shift : {0U, kBitsPerPass, 2 * kBitsPerPass}) {
    const auto digit = [&](std::uint32_t i) { return (keys[i] >> shift) & ((1U << kBitsPerPass) - 1); };
    std::array<std::uint32_t, (1U << kBitsPerPass) + 1> begin{};
    for (std::uint32_t i = 0; i < keys.size(); ++i) ++begin[digit(i) + 1];
    for (std::size_t d = 1; d < begin.size(); ++d) begin[d] += begin[d - 1];
    previous.swap(order);
    for (const std::uint32_t i : previous) order[begin[digit(i)]++] = i;
  }
  return order;
}

}  // namespace nephroid
