#include "core/sampling/halton.h"

#include <algorithm>
#include <array>

#include "core/assert.h"
#include "core/math.h"
#include "core/sampling/sampler.h"

namespace nephroid {
namespace {

constexpr std::array<std::uint32_t, kHaltonDimensions> makePrimes() {
  std::array<std::uint32_t, kHaltonDimensions> primes{};
  std::uint32_t candidate = 2;
  for (std::uint32_t& prime : primes) {
    const auto divides = [&](std::uint32_t p) { return p != 0 && candidate % p == 0; };
    while (std::any_of(primes.begin(), primes.end(), divides)) ++candidate;
    prime = candidate;
  }
  return primes;
}
constexpr auto kPrimes = makePrimes();

float clampBelowOne(double x) { return std::min(static_cast<float>(x), kOneMinusEpsilon); }

float computeRadicalInverse(std::uint32_t index, std::uint32_t base) {
  std::uint64_t reversed = 0, power = 1;
  for (; index != 0; index /= base) {
    reversed = reversed * base + index % base;
    power *= base;
  }
  return clampBelowOne(static_cast<double>(reversed) / static_cast<double>(power));
}

/// Scrambled digits go on for ever (a zero digit becomes another one): until they are below the resolution of float.
float computeScrambledInverse(std::uint32_t index, std::uint32_t base, std::uint64_t key) {
  double value = 0, digit_size = 1;
  while (digit_size > 0x1p-26) {
    const std::uint32_t digit = index % base;
    const std::uint64_t hash = detail::mixBits64(key);
    const auto factor = 1 + (hash >> 32) % (base - 1);
    const auto offset = (hash & 0xffffffffU) % base;
    digit_size /= base;
    value += static_cast<double>((factor * digit + offset) % base) * digit_size;
    key = detail::mixBits64(key + 0x9e3779b97f4a7c15ULL * (digit + 1));
    index /= base;
  }
  return clampBelowOne(value);
}

}  // namespace

float halton(std::uint32_t index, int dimension, std::uint32_t scramble_seed) {
  NEPHROID_ASSERT_GE(dimension, 0);
  NEPHROID_ASSERT_LT(dimension, kHaltonDimensions);
  const std::uint32_t base = kPrimes[static_cast<std::size_t>(dimension)];
  if (scramble_seed == 0) return computeRadicalInverse(index, base);
  const auto key = detail::mixBits64((std::uint64_t{scramble_seed} << 32) | static_cast<std::uint32_t>(dimension));
  return computeScrambledInverse(index, base, key);
}

}  // namespace nephroid
