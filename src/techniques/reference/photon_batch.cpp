#include "techniques/reference/photon_batch.h"

#include <algorithm>
#include <atomic>

#include "core/parallel.h"

namespace nephroid {
namespace {

/// Photons of one task: long enough to make scheduling cheap, short enough to stop promptly.
constexpr std::uint32_t kChunkPhotons = 4096;
/// Bands of the picture into which splats are summed in parallel.
constexpr std::size_t kSplatBands = 16;

}  // namespace

PhotonBatch::PhotonBatch(const LightTracer& tracer, std::uint32_t photons, std::size_t pixels)
    : tracer_(tracer),
      shares_(tracer.sharePhotons(photons)),
      band_pixels_((pixels + kSplatBands - 1) / kSplatBands),
      waves_(shares_.size()) {}

bool PhotonBatch::trace(std::uint64_t batch, const std::function<bool()>& stopped) {
  chunks_.clear();
  return emit(batch, stopped) && follow(stopped);
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

bool PhotonBatch::follow(const std::function<bool()>& stopped) {
  const std::size_t first = chunks_.size();
  for (std::size_t e = 0; e < waves_.size(); ++e) addChunks(e, waves_[e].size());
  return runChunks(first, stopped, [&](Chunk& c) {
    tracer_.trace(c.emitter, waves_[c.emitter], c.begin, c.end, c.tally);
    sortByBand(c);
  });
}

void PhotonBatch::sortByBand(Chunk& chunk) const {
  // Counting sort: stable, so that the sums keep the order of the photons.
  std::vector<Splat>& splats = chunk.tally.splats;
  for (const Splat& splat : splats) ++chunk.band_begin[splat.pixel / band_pixels_ + 1];
  for (std::size_t band = 0; band < kSplatBands; ++band) chunk.band_begin[band + 1] += chunk.band_begin[band];
  std::vector<std::uint32_t> next(chunk.band_begin.begin(), chunk.band_begin.end() - 1);
  std::vector<Splat> sorted(splats.size());
  for (const Splat& splat : splats) sorted[next[splat.pixel / band_pixels_]++] = splat;
  splats = std::move(sorted);
}

void PhotonBatch::visitSplats(const std::function<void(const Splat&, float scale)>& add) const {
  parallelFor(kSplatBands, [&](std::size_t band) {
    for (const Chunk& chunk : chunks_)
      for (std::uint32_t s = chunk.band_begin[band]; s < chunk.band_begin[band + 1]; ++s)
        add(chunk.tally.splats[s], scaleOf(chunk));
  });
}

}  // namespace nephroid
