#include "techniques/reference/gather_probe.h"

#include "techniques/reference/error_estimate.h"

namespace nephroid {
namespace {

double squared(double x) { return x * x; }

}  // namespace

GatherProbe::GatherProbe(const Film& film, std::string_view layer)
    : tiles_(film.width, film.height), pixels_(tiles_.count()) {
  for (const LayerPlanes& planes : planesOf(film, layer))
    if (planes.from_eye && planes.from_eye->active()) planes_.push_back(planes.from_eye);
}

/// The pixel in the middle of the tile, or what a narrower one has of it.
double GatherProbe::sumAt(std::size_t tile) const {
  std::size_t pixel = 0;
  tiles_.visitPixels(tile, [&](int x, int y) {
    constexpr int kMiddle = PictureTiles::kSide / 2;
    if (x % PictureTiles::kSide <= kMiddle && y % PictureTiles::kSide <= kMiddle) pixel = tiles_.pixelOf(x, y);
  });
  double sum = 0.0;
  for (const FilmPlane* plane : planes_) {
    const dvec3 value = plane->at(pixel);
    sum += value.x + value.y + value.z;
  }
  return sum / 3.0;
}

void GatherProbe::takeRound(std::span<const std::uint64_t> passes) {
  for (std::size_t tile = 0; tile < pixels_.size(); ++tile) {
    Pixel& p = pixels_[tile];
    const double gained = static_cast<double>(passes[tile]) - p.passes;
    if (gained <= 0.0) continue;
    const double sum = sumAt(tile);
    p.batch_squares += squared(sum - p.sum) / gained;
    p.batch_sum += sum - p.sum, p.batch_passes += gained, p.batch_rounds += 1.0;
    p.sum = sum, p.passes += gained;
  }
}

void GatherProbe::closeBatch() {
  for (Pixel& p : pixels_) {
    if (p.batch_passes == 0.0) continue;
    const double square = squared(p.batch_sum) / p.batch_passes;
    p.within += p.batch_squares - square, p.within_freedom += p.batch_rounds - 1.0;
    p.squares += square, p.passes_squared += squared(p.batch_passes), p.batches += 1.0;
    p.closed_sum = p.sum, p.closed_passes = p.passes;
    p.batch_sum = p.batch_passes = p.batch_rounds = p.batch_squares = 0.0;
  }
}

double GatherProbe::photonsShare() const {
  double brightness = 0.0;
  for (const Pixel& p : pixels_) brightness += p.closed_passes > 0.0 ? p.closed_sum / p.closed_passes : 0.0;
  const double floor = squared(kRelativeFloor * brightness / static_cast<double>(pixels_.size()));
  double paths = 0.0, photons = 0.0;
  for (const Pixel& p : pixels_) {
    if (p.batches < 2.0 || p.within_freedom < 1.0 || p.closed_sum == 0.0) continue;
    const double n = p.closed_passes, scale = squared(p.closed_sum / n) + floor;
    const double of_pass = p.within / p.within_freedom;
    const double between = (p.squares - squared(p.closed_sum) / n) / (p.batches - 1.0);
    const double of_batch = (between - of_pass) * (p.batches - 1.0) / (n - p.passes_squared / n);
    paths += of_pass / n / scale;
    photons += of_batch * p.passes_squared / squared(n) / scale;
  }
  // By chance batches may seem to agree better than they can.
  if (photons <= 0.0) return paths > 0.0 ? 0.0 : 1.0;
  return photons / (photons + paths);
}

}  // namespace nephroid
