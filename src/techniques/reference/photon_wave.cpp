#include "techniques/reference/photon_wave.h"

namespace nephroid {
namespace {

/// Marks a place that was left empty; no key of MortonOrder has all bits.
constexpr std::uint32_t kEmpty = 0xFFFFFFFFU;

}  // namespace

void PhotonWave::reset(std::uint64_t first, std::uint32_t count) {
  first_ = first;
  photons_.resize(count);
  keys_.assign(count, kEmpty);
  order_.clear();
}

void PhotonWave::put(std::uint32_t index, const Photon& photon, std::uint32_t key) {
  photons_[index] = photon;
  keys_[index] = key;
}

void PhotonWave::close(bool sort) {
  order_ = MortonOrder::sort(sort ? keys_ : std::vector<std::uint32_t>(keys_.size(), 0));
  std::erase_if(order_, [&](std::uint32_t i) { return keys_[i] == kEmpty; });
}

}  // namespace nephroid
