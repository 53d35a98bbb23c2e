// Inputs of the micro-benchmarks: the same in every run, too many for the compiler or the branch predictor to learn.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/math.h"
#include "core/sampling/sampler.h"
#include "core/sampling/warp.h"

namespace nephroid::bench {

/// How many inputs a loop goes round. 4096 vectors are 48 kB: they stay in the second level of any cache, so what is
/// measured is the function.
inline constexpr std::size_t kInputCount = 4096;

/// `kInputCount` values, made by `make(sampler)` from one sampler each.
template <class Make>
auto makeInputs(const Make& make) {
  std::vector<decltype(make(std::declval<Sampler&>()))> inputs;
  for (std::uint32_t i = 0; i < kInputCount; ++i) {
    Sampler sampler(7, 1, i);
    inputs.push_back(make(sampler));
  }
  return inputs;
}

/// Points of the unit square.
inline std::vector<vec2> makeSquarePoints() {
  return makeInputs([](Sampler& sampler) { return sampler.next2D(); });
}

/// Unit vectors of the hemisphere about +Z, by cosine.
inline std::vector<vec3> makeHemisphereDirs() {
  return makeInputs([](Sampler& sampler) { return sampleCosineHemisphere(sampler.next2D()); });
}

/// Goes round the inputs for ever.
template <class T>
class Cycle {
 public:
  explicit Cycle(std::vector<T> inputs) : inputs_(std::move(inputs)) {}
  const T& next() {
    static_assert((kInputCount & (kInputCount - 1)) == 0);
    return inputs_[next_++ & (kInputCount - 1)];
  }

 private:
  std::vector<T> inputs_;
  std::size_t next_ = 0;
};

}  // namespace nephroid::bench
