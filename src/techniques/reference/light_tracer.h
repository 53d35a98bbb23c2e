// Light tracing: photons from the lights, aimed at what bends them, connected to the camera where they end (after
// Arvo 1986, "Backward ray tracing"; camera connection after Dutré, Lafortune, Willems 1993).
//
// Makes the paths L S … D E: the caustic (L S⁺ D E) and what a caustic lights in turn (L S … D E with further D).
// Unbiased, no kernel: a photon counts for the one pixel that sees it.
// Limits: only what the camera sees directly or through panes; a caustic in a mirror is the path tracer's.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "techniques/reference/photon_tally.h"
#include "techniques/reference/photon_wave.h"
#include "techniques/reference/world.h"

namespace nephroid {

class LightTracer {
 public:
  /// @param continue_after_diffuse  also trace what a caustic lights in turn
  /// @param keep_deposits           list where caustic photons end, for those who look at it through glass
  LightTracer(const ReferenceWorld& world, bool continue_after_diffuse, bool keep_deposits = false);

  std::span<const std::unique_ptr<Emitter>> emitters() const { return emitters_; }
  /// Photons of a batch for each emitter, by flux, at least one each; sums to `total` or a little more.
  std::vector<std::uint32_t> sharePhotons(std::uint32_t total) const;
  // All that follow are deterministic and safe from any thread, also for parts of one wave at once.

  /// Emits photons [begin, end) of a wave of an emitter, counted from the wave's first.
  void emit(std::size_t emitter, std::uint32_t begin, std::uint32_t end, PhotonWave& wave, PhotonTally& tally) const;
  /// Traces photons [begin, end) of the order of a wave.
  void trace(std::size_t emitter, const PhotonWave& wave, std::uint32_t begin, std::uint32_t end,
             PhotonTally& tally) const;
  bool anyTarget() const { return !targets_->empty(); }

 private:
  Sampler samplerOf(std::size_t emitter, std::uint64_t photon) const;

  const ReferenceWorld& world_;
  bool continue_after_diffuse_, keep_deposits_;
  std::vector<bool> is_target_;
  std::unique_ptr<EmissionTargets> targets_;
  std::vector<std::unique_ptr<Emitter>> emitters_;
};

}  // namespace nephroid
