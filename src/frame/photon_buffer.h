// Photons on the device: what transport writes and a deposit reads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/optics/photon.shared.h"
#include "frame/deposit.shared.h"
#include "gpu/commands.h"

namespace nephroid {

/// Room for one batch of photons (core/optics/photon.shared.h), in chunks that a shader may have bound: a device may
/// allow no more than 128 MiB at a time, which is two million photons. Move-only.
class PhotonBuffer {
 public:
  /// Photons [first, first + count) of the batch.
  struct Chunk {
    std::uint32_t first = 0, count = 0;
    gpu::Buffer buffer;
  };

  PhotonBuffer() = default;
  /// @param capacity  photons, > 0. What they are is undefined until they are written.
  /// @param align     each chunk but the last has a multiple of as many photons: whole rows of an emission grid, say
  /// @throws ResourceError
  PhotonBuffer(gpu::Device& device, std::uint32_t capacity, std::uint32_t align = 1);

  std::uint32_t capacity() const { return capacity_; }
  std::span<const Chunk> chunks() const { return chunks_; }

  /// What holds for all photons that are in it now: set by who writes them.
  PhotonBatch batch{};
  /// Of a grid, if who writes the photons says so (makeSquares): a word for each square of kDepositSquare² cells that
  /// begins at a multiple of kDepositSquare photons along both axes, row by row; not 0 where the photons in it and
  /// about it took the same way and where they end bends slowly. Invalid: nothing is known.
  gpu::Buffer squares;
  std::uint32_t squaresAcross() const { return squares.valid() ? acrossSquares(batch.grid_width) : 0; }
  /// Makes room for them, by `batch`. @throws ResourceError
  void makeSquares(gpu::Device& device);

 private:
  static std::uint32_t acrossSquares(std::uint32_t photons) { return (photons + kDepositSquare - 1) / kDepositSquare; }

  std::uint32_t capacity_ = 0;
  std::vector<Chunk> chunks_;
};

/// All photons, in order. For tests and for tools, not for frames.
std::vector<Photon> readPhotons(gpu::Device& device, const PhotonBuffer& photons);

}  // namespace nephroid
