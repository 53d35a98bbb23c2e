// One batch of photons from all lights, over all threads, and its splats on their way to the film.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "techniques/reference/light_tracer.h"

namespace nephroid {

class PhotonBatch {
 public:
  /// What a run of photons of one light left, in an order that depends on the photons alone, never on threads.
  struct Chunk {
    std::size_t emitter = 0;
    std::uint32_t begin = 0, end = 0;  ///< of the wave: first emission, then (in other chunks) the sorted order
    PhotonTally tally;                 ///< its splats by band
    std::vector<std::uint32_t> band_begin;
    std::vector<std::vector<std::uint32_t>> footprints_of_band;  ///< into tally.footprints, each in every band it meets
  };

  /// Most photons of a batch: what is held in memory of each is some 72 bytes and its splats, 32 bytes each.
  static constexpr std::uint32_t kMaxPhotons = 1U << 18;

  /// @param photons  of all lights together, at most kMaxPhotons; each light gets a share by its flux
  /// @param width,height  of the picture
  PhotonBatch(const LightTracer& tracer, std::uint32_t photons, int width, int height);
  /// From the next batch on, caustic photons are spread over `view`, the tracer's, which must outlive the batch.
  /// @param overlaps  of footprints, by emitter (see scaleFootprints)
  void spreadOver(const ReceiverView* view, std::vector<float> overlaps) {
    view_ = view;
    overlaps_ = std::move(overlaps);
  }

  /// Traces batch number `batch`. @param stopped  asked now and then, from any thread
  /// @return false if it was stopped: then it is of no use, for half a batch would favour some lights over others
  bool trace(std::uint64_t batch, const std::function<bool()>& stopped);

  /// Photons of a batch, by emitter.
  const std::vector<std::uint32_t>& shares() const { return shares_; }
  std::span<const Chunk> chunks() const { return chunks_; }
  std::span<Chunk> chunks() { return chunks_; }
  /// Calls `add(splat, pixel, weights)` for every splat and every row of neighbouring pixels that it counts for, from
  /// `pixel` on: in parallel for different pixels, in a fixed order for each pixel. Weights hold the scale.
  void visitSplats(
      const std::function<void(const Splat&, std::uint32_t pixel, std::span<const float> weights)>& add) const;
  /// What turns a photon's flux into watts: one over the photons of its emitter.
  float scaleOf(const Chunk& chunk) const { return 1.0F / static_cast<float>(shares_[chunk.emitter]); }

 private:
  void addChunks(std::size_t emitter, std::uint32_t photons);
  bool emit(std::uint64_t batch, const std::function<bool()>& stopped);
  bool follow(std::uint64_t batch, const std::function<bool()>& stopped);
  template <class Work>
  bool runChunks(std::size_t first, const std::function<bool()>& stopped, Work&& work);
  void sortByBand(Chunk& chunk) const;
  void sortFootprints(Chunk& chunk) const;

  const LightTracer& tracer_;
  std::vector<std::uint32_t> shares_;  ///< by emitter
  int width_, height_, band_rows_;
  const ReceiverView* view_ = nullptr;
  std::vector<float> overlaps_;    ///< by emitter
  std::vector<PhotonWave> waves_;  ///< by emitter
  std::vector<Chunk> chunks_;
};

}  // namespace nephroid
