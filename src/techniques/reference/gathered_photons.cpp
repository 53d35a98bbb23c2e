#include "techniques/reference/gathered_photons.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace nephroid {
namespace {

/// Photons under a kernel of the first batch: fewer is noise, more is blur.
constexpr float kCausticPhotons = 15.0F;
/// The same of what a caustic lights in turn: smooth, so that more may be blurred. Of `pool` it was four fifths of the
/// noise of what is seen through water, with as many as of caustics.
constexpr float kIndirectPhotons = 30.0F;
/// Share of the photons that a shrinking kernel keeps; 2/3 balances bias and variance (Knaus & Zwicker 2011).
constexpr double kRadiusAlpha = 2.0 / 3.0;
/// Batches that count before the first as far as shrinking goes. Noise of a single batch is far above blur: of `pool`
/// the squares are 0.05 and 0.00015. With kernels as large as at first they would be equal after some hundred batches,
/// and narrower kernels are noisier.
constexpr double kWholeBatches = 64.0;
/// Kernels at most, and at least, over one that suits the map as a whole.
constexpr float kWidest = 3.0F, kNarrowest = 0.25F;
/// Kernels of caustics at least, over one that would suit photons spread evenly: a focus may be a point.
constexpr float kNarrowestOfEven = 1.0F / 64.0F;

using Deposits = std::vector<GridPhoton> PhotonTally::*;

std::vector<GridPhoton> collect(const PhotonBatch& batch, Deposits kind) {
  std::vector<GridPhoton> deposits;
  for (const PhotonBatch::Chunk& chunk : batch.chunks()) {
    for (GridPhoton photon : chunk.tally.*kind) {
      photon.flux *= batch.scaleOf(chunk);
      deposits.push_back(photon);
    }
  }
  return deposits;
}

}  // namespace

void GatheredPhotons::Map::take(const std::vector<GridPhoton>& photons, std::uint64_t batch, float scale) {
  if (next_by != kUndecided) radii = next_radii, decided_by = next_by;
  if (const std::optional<KernelRadii> own = radiiBy(photons)) {
    next_radii = *own, next_by = batch;
    if (decided_by == kUndecided) radii = *own, decided_by = batch;
  }
  spread(photons, scale);
}

void GatheredPhotons::Map::retake(const std::vector<GridPhoton>& photons, std::uint64_t batch) {
  if (batch != decided_by && batch != next_by) return;
  const std::optional<KernelRadii> own = radiiBy(photons);
  if (own && batch == decided_by) radii = *own;
  if (own && batch == next_by) next_radii = *own;
}

std::optional<KernelRadii> GatheredPhotons::Map::radiiBy(const std::vector<GridPhoton>& photons) const {
  const RadiusRange range = choose_range(photons, expected);
  if (range.narrowest <= 0.0F) return std::nullopt;
  return KernelRadii(photons, expected, range.narrowest, range.widest);
}

void GatheredPhotons::Map::spread(const std::vector<GridPhoton>& photons, float scale) {
  kernels = decided_by != kUndecided ? KernelMap(photons, radii, scale) : KernelMap();
}

GatheredPhotons::GatheredPhotons() {
  caustics_.expected = kCausticPhotons, caustics_.choose_range = chooseRangeOfCaustics;
  indirect_.expected = kIndirectPhotons, indirect_.choose_range = chooseRangeOfIndirect;
}

void GatheredPhotons::take(const PhotonBatch& batch, std::uint64_t batch_index) {
  const float scale = std::sqrt(shrinkAreas(taken_));
  latest_ = batch_index;
  ++taken_;
  caustics_.take(collect(batch, &PhotonTally::caustic_deposits), batch_index, scale);
  indirect_.take(collect(batch, &PhotonTally::indirect_deposits), batch_index, scale);
}

void GatheredPhotons::retake(const PhotonBatch& batch, std::uint64_t batch_index) {
  const std::vector<GridPhoton> caustic = collect(batch, &PhotonTally::caustic_deposits),
                                indirect = collect(batch, &PhotonTally::indirect_deposits);
  caustics_.retake(caustic, batch_index);
  indirect_.retake(indirect, batch_index);
  if (batch_index != latest_) return;
  const float scale = std::sqrt(shrinkAreas(taken_ - 1));
  caustics_.spread(caustic, scale);
  indirect_.spread(indirect, scale);
}

std::vector<std::uint64_t> GatheredPhotons::batchesToRetake() const {
  std::set<std::uint64_t> batches;
  for (const Map* map : {&caustics_, &indirect_})
    for (const std::uint64_t batch : {map->decided_by, map->next_by})
      if (batch != kUndecided) batches.insert(batch);
  if (taken_ > 0) batches.insert(latest_);
  return {batches.begin(), batches.end()};
}

RadiusRange chooseRangeOfCaustics(std::span<const GridPhoton> photons, float expected) {
  const float even = chooseGatherRadius(photons, expected), typical = chooseTypicalRadius(photons, expected);
  return {.narrowest = std::clamp(typical, kNarrowestOfEven * even, kNarrowest * even), .widest = kWidest * even};
}

RadiusRange chooseRangeOfIndirect(std::span<const GridPhoton> photons, float expected) {
  const float radius = chooseTypicalRadius(photons, expected);
  return {.narrowest = kNarrowest * radius, .widest = kWidest * radius};
}

float shrinkAreas(std::uint64_t batch) {
  // Σ log((j + α)/(j + 1)) over j from kWholeBatches + 1 to kWholeBatches + batch.
  const double first = kWholeBatches + 1.0, k = static_cast<double>(batch);
  return static_cast<float>(std::exp(std::lgamma(first + k + kRadiusAlpha) - std::lgamma(first + kRadiusAlpha) -
                                     std::lgamma(first + k + 1.0) + std::lgamma(first + 1.0)));
}

float chooseTypicalRadius(std::span<const GridPhoton> photons, float expected) {
  // Of some photons the distance to the tenth other among some; among all of them it is the nearer the more they are.
  constexpr std::size_t kAsked = 64, kOthers = 1 << 14;
  if (photons.size() < 2) return 0.0F;
  const std::size_t step = (photons.size() + kOthers - 1) / kOthers;
  const std::size_t others = (photons.size() + step - 1) / step;
  const auto rank = static_cast<std::ptrdiff_t>(std::min(static_cast<std::size_t>(expected), others - 1));
  const std::size_t asked = std::min(kAsked, photons.size());
  std::vector<float> squared, radii_squared;
  for (std::size_t i = 0; i < asked; ++i) {
    const vec3 centre = photons[i * photons.size() / asked].position;
    squared.clear();
    for (std::size_t other = 0; other < photons.size(); other += step) {
      const vec3 offset = photons[other].position - centre;
      squared.push_back(dot(offset, offset));
    }
    std::nth_element(squared.begin(), squared.begin() + rank, squared.end());
    radii_squared.push_back(squared[static_cast<std::size_t>(rank)]);
  }
  std::nth_element(radii_squared.begin(), radii_squared.begin() + static_cast<std::ptrdiff_t>(asked / 2),
                   radii_squared.end());
  return std::sqrt(radii_squared[asked / 2] / static_cast<float>(step));
}

}  // namespace nephroid
