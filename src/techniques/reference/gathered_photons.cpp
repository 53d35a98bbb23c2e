#include "techniques/reference/gathered_photons.h"

#include <algorithm>
#include <cmath>

namespace nephroid {
namespace {

/// Photons under the first kernel, were they spread evenly: fewer is noise, more is blur.
constexpr int kGatherPhotons = 10;
/// Share of the photons that a shrinking kernel keeps; 2/3 balances bias and variance (Knaus & Zwicker 2011).
constexpr double kRadiusAlpha = 2.0 / 3.0;

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

/// Knaus & Zwicker 2011, eq. 15.
void GatheredPhotons::Map::shrink(std::uint64_t batches) {
  const auto k = static_cast<double>(batches - 1);
  radius_squared *= (k + kRadiusAlpha) / (k + 1.0);
}

void GatheredPhotons::Map::replace(const std::vector<GridPhoton>& deposits) {
  const auto radius = static_cast<float>(std::sqrt(radius_squared));
  grid = radius > 0.0F ? PhotonGrid(deposits, radius) : PhotonGrid();
}

void GatheredPhotons::take(const PhotonBatch& batch, std::uint64_t batches) {
  const auto takeInto = [&](Map& map, Deposits kind, const auto& chooseRadius) {
    const std::vector<GridPhoton> deposits = collect(batch, kind);
    if (map.radius_squared == 0.0) {
      const double radius = chooseRadius(deposits, kGatherPhotons);
      map.radius_squared = radius * radius;
    } else {
      map.shrink(batches);
    }
    map.replace(deposits);
  };
  takeInto(caustics_, &PhotonTally::caustic_deposits, chooseGatherRadius);
  takeInto(indirect_, &PhotonTally::indirect_deposits, chooseTypicalRadius);
}

void GatheredPhotons::retake(const PhotonBatch& batch) {
  caustics_.replace(collect(batch, &PhotonTally::caustic_deposits));
  indirect_.replace(collect(batch, &PhotonTally::indirect_deposits));
}

float chooseTypicalRadius(const std::vector<GridPhoton>& photons, int expected) {
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
