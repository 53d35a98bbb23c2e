// Light tracing: photons from the lights, aimed at what bends them, connected to the camera where they end (after
// Arvo 1986, "Backward ray tracing"; camera connection after Dutré, Lafortune, Willems 1993).
//
// Makes the paths L S … D E: the caustic (L S⁺ D E) and what a caustic lights in turn (L S … D E with further D).
// Unbiased, no kernel: a photon counts for the one pixel that sees it.
// Only what the camera sees directly or through panes; for what is seen in mirrors and through glass photons leave
// deposits, which paths from the eye gather (see gathered_photons.h).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "techniques/reference/footprint_splat.h"
#include "techniques/reference/path_class.h"
#include "techniques/reference/photon_tally.h"
#include "techniques/reference/photon_wave.h"
#include "techniques/reference/vcm/techniques.h"
#include "techniques/reference/world.h"

namespace nephroid {

class LightTracer {
 public:
  /// @param connect  of L S⁺ D E and L S … D … D E those that are connected to the camera
  LightTracer(const ReferenceWorld& world, const PhotonPaths& connect);
  /// From now on photons are listed where they meet diffuse surfaces, for those who gather them.
  /// @param indirect_too  not only where they do so first; an unbiased share of them
  void keepDeposits(bool indirect_too) {
    keep_deposits_ = true;
    keep_indirect_deposits_ = indirect_too;
  }
  /// From now on caustics that a manifold walk finds (see manifold/share.h) are left to it, seen directly or not.
  void leaveWalkedCaustics() { leave_walked_ = true; }
  /// From now on photons carry weights of vertex connection and merging, and leave their vertices in the tally.
  /// @param techniques  must outlive all that is traced
  void carryWeights(const VcmTechniques* techniques) { vcm_ = techniques; }
  /// What photons are aimed at, by instance.
  const std::vector<bool>& targets() const { return is_target_; }

  std::span<const std::unique_ptr<Emitter>> emitters() const { return emitters_; }
  /// Photons of a batch for each emitter, by flux, at least one each; sums to `total` or a little more.
  std::vector<std::uint32_t> sharePhotons(std::uint32_t total) const;
  // All that follow are deterministic and safe from any thread, also for parts of one wave at once.

  /// Emits photons [begin, end) of a wave of an emitter, counted from the wave's first.
  void emit(std::size_t emitter, std::uint32_t begin, std::uint32_t end, PhotonWave& wave, PhotonTally& tally) const;
  /// From now on caustic photons may be spread over what pixels see of their receivers; `view` must outlive the tracer.
  void spreadOver(const ReceiverView* view) { view_ = view; }
  /// As the function of this name, for the picture of the view.
  FootprintScale scaleFootprints(float overlap, std::uint32_t photons, std::uint64_t batch) const {
    return nephroid::scaleFootprints(overlap, photons, batch,
                                     static_cast<std::size_t>(view_->width()) * view_->height());
  }
  /// Traces photons [begin, end) of the order of a wave. @param spread  needs a view to be spread over
  void trace(std::size_t emitter, const PhotonWave& wave, std::uint32_t begin, std::uint32_t end,
             const FootprintScale& spread, PhotonTally& tally) const;
  /// Where one photon, traced alone, is first seen to end, not normalised; nothing if it is not or has no footprint.
  std::optional<FootprintSplat> findLanding(std::size_t emitter, const PhotonWave::Photon& photon,
                                            const FootprintScale& spread) const;
  /// What one photon, traced alone as far as its first caustic, adds to the picture, as far as caustics are connected
  /// to the camera, and leaves to be gathered if deposits are kept; its footprints are not normalised.
  PhotonTally traceAlone(std::size_t emitter, const PhotonWave::Photon& photon, const FootprintScale& spread) const;
  /// From now on photons of an emitter leave it by this density, or evenly without one. @pre it can be guided
  void guide(std::size_t emitter, std::optional<EmissionGuide> guide) { emitters_[emitter]->guideBy(std::move(guide)); }
  bool anyTarget() const { return !targets_->empty(); }

 private:
  Sampler samplerOf(std::size_t emitter, std::uint64_t photon) const;
  vec3 lightNormalOf(std::size_t emitter, std::uint64_t photon) const;

  const ReferenceWorld& world_;
  PhotonPaths connect_;
  bool keep_deposits_ = false, keep_indirect_deposits_ = false, leave_walked_ = false;
  const ReceiverView* view_ = nullptr;
  const VcmTechniques* vcm_ = nullptr;
  std::vector<bool> is_target_;
  std::unique_ptr<EmissionTargets> targets_;
  std::vector<std::unique_ptr<Emitter>> emitters_;
};

}  // namespace nephroid
