#include "techniques/reference/photon_batch.h"

#include <algorithm>
#include <atomic>

#include "core/parallel.h"

namespace nephroid {
namespace {

/// Photons of one task: long enough to make scheduling cheap, short enough to stop promptly.
constexpr std::uint32_t kChunkPhotons = 4096;
/// Bands of the picture into which splats are summed in parallel.
constexpr int kSplatBands = 16;
/// Photons of one batch that overlap where they are gathered, were the light's way straight: fewer are noise, more are
/// blur.
constexpr float kGatheredOverlap = 8.0F;

}  // namespace

PhotonBatch::PhotonBatch(const LightTracer& tracer, std::uint32_t photons, int width, int height)
    : tracer_(tracer),
      shares_(tracer.sharePhotons(photons)),
      width_(width),
      height_(height),
      band_rows_((height + kSplatBands - 1) / kSplatBands),
      waves_(shares_.size()) {}

bool PhotonBatch::trace(std::uint64_t batch, const std::function<bool()>& stopped) {
  chunks_.clear();
  return emit(batch, stopped) && follow(batch, stopped);
}

template <class Work>
bool PhotonBatch::runChunks(std::size_t first, const std::function<bool()>& stopped, Work&& work) {
  std::atomic<bool> complete{true};
  parallelFor(chunks_.size() - first, [&](std::size_t i) {
    if (stopped())
      complete = false;
    else
      work(chunks_[first + i]);
  });
  return complete;
}

void PhotonBatch::addChunks(std::size_t emitter, std::uint32_t photons) {
  for (std::uint32_t i = 0; i < photons; i += kChunkPhotons) {
    Chunk& chunk = chunks_.emplace_back();
    chunk.emitter = emitter;
    chunk.begin = i, chunk.end = std::min(i + kChunkPhotons, photons);
    chunk.band_begin.assign(kSplatBands + 1, 0);
  }
}

bool PhotonBatch::emit(std::uint64_t batch, const std::function<bool()>& stopped) {
  for (std::size_t e = 0; e < shares_.size(); ++e) {
    waves_[e].reset(batch * shares_[e], shares_[e]);
    addChunks(e, shares_[e]);
  }
  if (!runChunks(0, stopped, [&](Chunk& c) { tracer_.emit(c.emitter, c.begin, c.end, waves_[c.emitter], c.tally); }))
    return false;
  parallelFor(waves_.size(), [&](std::size_t e) { waves_[e].close(); });
  return true;
}

bool PhotonBatch::follow(std::uint64_t batch, const std::function<bool()>& stopped) {
  const std::size_t first = chunks_.size();
  for (std::size_t e = 0; e < waves_.size(); ++e) addChunks(e, waves_[e].size());
  return runChunks(first, stopped, [&](Chunk& c) {
    FootprintScale spread;
    if (view_) spread = tracer_.scaleFootprints(overlaps_[c.emitter], shares_[c.emitter], batch);
    spread.gathered_cell = kGatheredOverlap / static_cast<float>(shares_[c.emitter]);
    tracer_.trace(c.emitter, waves_[c.emitter], c.begin, c.end, spread, c.tally);
    sortByBand(c);
    sortFootprints(c);
  });
}

void PhotonBatch::sortByBand(Chunk& chunk) const {
  // Counting sort: stable, so that the sums keep the order of the photons.
  std::vector<Splat>& splats = chunk.tally.splats;
  const std::uint32_t band_pixels = static_cast<std::uint32_t>(band_rows_) * static_cast<std::uint32_t>(width_);
  for (const Splat& splat : splats) ++chunk.band_begin[splat.pixel / band_pixels + 1];
  for (int band = 0; band < kSplatBands; ++band) chunk.band_begin[band + 1] += chunk.band_begin[band];
  std::vector<std::uint32_t> next(chunk.band_begin.begin(), chunk.band_begin.end() - 1);
  std::vector<Splat> sorted(splats.size());
  for (const Splat& splat : splats) sorted[next[splat.pixel / band_pixels]++] = splat;
  splats = std::move(sorted);
}

void PhotonBatch::sortFootprints(Chunk& chunk) const {
  chunk.footprints_of_band.assign(kSplatBands, {});
  const std::vector<FootprintSplat>& footprints = chunk.tally.footprints;
  for (std::uint32_t i = 0; i < footprints.size(); ++i) {
    const int first = std::max(firstRowOf(footprints[i]), 0) / band_rows_;
    const int last = std::min(lastRowOf(footprints[i]), height_ - 1) / band_rows_;
    for (int band = first; band <= last; ++band) chunk.footprints_of_band[static_cast<std::size_t>(band)].push_back(i);
  }
}

void PhotonBatch::visitSplats(
    const std::function<void(const Splat&, std::uint32_t pixel, std::span<const float> weights)>& add) const {
  parallelFor(kSplatBands, [&](std::size_t band) {
    const int first_row = static_cast<int>(band) * band_rows_, end_row = std::min(first_row + band_rows_, height_);
    for (const Chunk& chunk : chunks_) {
      const float scale = scaleOf(chunk);
      for (std::uint32_t s = chunk.band_begin[band]; s < chunk.band_begin[band + 1]; ++s)
        add(chunk.tally.splats[s], chunk.tally.splats[s].pixel, {&scale, 1});
      if (chunk.footprints_of_band.empty()) continue;
      for (const std::uint32_t f : chunk.footprints_of_band[band]) {
        FootprintSplat footprint = chunk.tally.footprints[f];
        footprint.weight_scale *= scale;
        visitFootprint(*view_, footprint, first_row, end_row, [&](const FootprintRow& row) {
          add(footprint.splat, static_cast<std::uint32_t>(row.y * width_ + row.x_first),
              {row.weights.data(), static_cast<std::size_t>(row.x_end - row.x_first)});
        });
      }
    }
  });
}

}  // namespace nephroid
