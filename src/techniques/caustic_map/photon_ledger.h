// Where the flux of a light went, photon by photon, summed on the device.
#pragma once

#include <cstdint>
#include <vector>

#include "frame/photon_buffer.h"
#include "gpu/commands.h"
#include "techniques/caustic_map/transport.shared.h"
#include "techniques/ledger.h"

namespace nephroid {

/// Adds up what transport wrote: what photons carry, by how they ended, and what they left on the way. Sums are taken
/// in an order of their own, so two runs give the same. It costs about as much as transport itself, so it is recorded
/// for those who ask. Not thread-safe. The device must outlive it.
class PhotonLedger {
 public:
  /// @param photons  at most, of one run of transport
  /// @param records  at most, until the next `begin`: lights × views × branches × bands
  /// @throws ResourceError
  PhotonLedger(gpu::Device& device, std::uint32_t photons, std::uint32_t records);

  /// For TransportSettings::account: of one run of transport, until `record` has added it up.
  const gpu::Buffer& account() const { return account_; }
  /// Forgets all records.
  void begin() { records_.clear(); }
  /// Adds up the first photons, after transport (and whoever drops photons later) has run.
  /// @param light   of which
  /// @param branch  the first one has the emitted flux of all
  void record(gpu::CommandRecorder& recorder, const PhotonBuffer& photons, std::uint32_t count, std::uint32_t light,
              std::uint32_t branch);
  /// The ledger of one light, of everything recorded since `begin`. Waits for the device. Its name is left empty.
  Ledger read(std::uint32_t light) const;

 private:
  struct Record {
    std::uint32_t light = 0;
    std::uint32_t emitted_count = 0;
  };

  gpu::Device& device_;
  gpu::ComputePipeline rows_pipeline_, sum_pipeline_;
  gpu::Buffer account_, rows_, sums_;
  std::uint32_t most_records_;
  std::vector<Record> records_;
};

}  // namespace nephroid
