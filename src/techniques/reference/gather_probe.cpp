#include "techniques/reference/gather_probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "techniques/reference/error_estimate.h"

namespace nephroid {
namespace {

/// Passes whose pairs are looked at. Later ones are made otherwise, where paths learn how to go on, and what is made
/// otherwise cannot be held against each other.
constexpr double kPairedPasses = 16.0;

/// Groups of pixels, and how many of those that say most, and least, are not heard: next to outlines a few pixels
/// differ so much from pass to pass that they would outweigh what the others say.
constexpr std::size_t kGroups = 15, kUnheard = 2;
double meanOf(std::array<double, kGroups> values) {
  std::ranges::sort(values);
  return std::accumulate(values.begin() + kUnheard, values.end() - kUnheard, 0.0) / (kGroups - 2 * kUnheard);
}

double squared(double x) { return x * x; }

}  // namespace

GatherProbe::GatherProbe(const Film& film, std::string_view layer) {
  for (const LayerPlanes& planes : planesOf(film, layer))
    if (planes.from_eye && planes.from_eye->active()) planes_.push_back(planes.from_eye);
  const PictureTiles tiles(film.width, film.height);
  for (std::size_t tile = 0; tile < tiles.count(); ++tile)
    tiles.visitPixels(tile, [&](int x, int y) {
      // One of each row, no two in a column; the first of a tile is always there.
      constexpr int kSide = PictureTiles::kSide, kStep = 3;
      if (x % kSide == y * kStep % kSide) pixels_.push_back({.tile = tile, .pixel = tiles.pixelOf(x, y)});
    });
}

double GatherProbe::sumAt(std::size_t pixel) const {
  double sum = 0.0;
  for (const FilmPlane* plane : planes_) {
    const dvec3 value = plane->at(pixel);
    sum += value.x + value.y + value.z;
  }
  return sum / 3.0;
}

void GatherProbe::takeRound(std::span<const std::uint64_t> passes) {
  for (Pixel& p : pixels_) {
    const double gained = static_cast<double>(passes[p.tile]) - p.passes;
    if (gained <= 0.0) continue;
    const double sum = sumAt(p.pixel);
    if (gained == 1.0 && p.passes < kPairedPasses)
      p.takePass(sum - p.sum);
    else
      p.first_batch = -1.0;
    p.batch_sum += sum - p.sum, p.batch_passes += gained;
    p.sum = sum, p.passes += gained;
  }
}

/// One pass, before it is counted.
void GatherProbe::Pixel::takePass(double value) {
  const bool begins = std::fmod(passes, 2.0) == 0.0;
  if (!begins && first_batch >= 0.0) {
    Pairs& pairs = first_batch == batches ? of_one_batch : of_two;
    pairs.squares += 0.5 * squared(value - first), pairs.count += 1.0;
  }
  first = value, first_batch = begins ? batches : -1.0;
}

void GatherProbe::closeBatch() {
  for (Pixel& p : pixels_) {
    if (p.batch_passes == 0.0) continue;
    p.squares += squared(p.batch_sum) / p.batch_passes;
    p.passes_squared += squared(p.batch_passes), p.batches += 1.0;
    p.closed_sum = p.sum, p.closed_passes = p.passes;
    p.batch_sum = p.batch_passes = 0.0;
  }
}

std::optional<GatherProbe::Parts> GatherProbe::parts() const {
  double brightness = 0.0;
  for (const Pixel& p : pixels_) brightness += p.closed_passes > 0.0 ? p.closed_sum / p.closed_passes : 0.0;
  const double floor = squared(kRelativeFloor * brightness / static_cast<double>(pixels_.size()));
  Parts sum;
  std::array<double, kGroups> of_batch{}, photons{}, between_batches{};  // by group, of the photons
  std::size_t count = 0;
  for (const Pixel& p : pixels_) {
    if (!p.isKnown() || p.closed_sum == 0.0) continue;
    const double n = p.closed_passes, scale = squared(p.closed_sum / n) + floor;
    const double mean_squared = p.passes_squared / n;  // of passes by batch, weighted by passes
    const double between = (p.squares - squared(p.closed_sum) / n) / (p.batches - 1.0);
    sum.paths += between / n / scale;
    const double photon_variance = (p.of_two.mean() - p.of_one_batch.mean()) / scale;
    const std::size_t group = count++ % kGroups;
    of_batch[group] += photon_variance;
    photons[group] += photon_variance * mean_squared / n;
    between_batches[group] += photon_variance * (n - mean_squared) / (p.batches - 1.0) / n;
  }
  if (count == 0) return std::nullopt;
  sum.of_batch = kGroups * meanOf(of_batch);
  sum.photons = kGroups * meanOf(photons);
  sum.paths -= kGroups * meanOf(between_batches);
  // By chance one may seem to be less than nothing.
  for (double* part : {&sum.paths, &sum.photons, &sum.of_batch}) *part = std::max(*part, 0.0);
  return sum;
}

}  // namespace nephroid
