// One photon on its way from a light, and what it sends to the camera.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "techniques/reference/footprint.h"
#include "techniques/reference/footprint_splat.h"
#include "techniques/reference/manifold/share.h"
#include "techniques/reference/photon_tally.h"
#include "techniques/reference/vcm/light_trail.h"
#include "techniques/reference/world.h"
#include "trace/bsdf.h"

namespace nephroid {

/// Splats that wait for their lines to the camera to be traced, several at once.
class CameraConnections {
 public:
  /// @param view  over which footprints are spread; null: they are kept as they are
  CameraConnections(const Walker& walker, const ReceiverView* view, PhotonTally& tally)
      : walker_(walker), view_(view), tally_(tally) {}
  /// @param splat  as if nothing were between
  void add(const Sightline& line, const Splat& splat) { add(line, splat, std::nullopt); }
  /// @param footprint  of the same splat
  void add(const Sightline& line, const Splat& splat, const std::optional<FootprintSplat>& footprint) {
    lines_[count_] = line;
    splats_[count_] = splat;
    footprints_[count_] = footprint;
    if (++count_ == TraceScene::kPacketSize) flush();
  }
  void flush();

 private:
  void keep(const Splat& splat, std::optional<FootprintSplat>& footprint);

  const Walker& walker_;
  const ReceiverView* view_;
  PhotonTally& tally_;
  std::size_t count_ = 0;
  std::array<Sightline, TraceScene::kPacketSize> lines_;
  std::array<Splat, TraceScene::kPacketSize> splats_;
  std::array<std::optional<FootprintSplat>, TraceScene::kPacketSize> footprints_;
};

/// What the photons of one run share.
struct LightPathContext {
  const ReferenceWorld& world;
  const std::vector<bool>& is_target;  ///< by instance
  bool connect_indirect;               ///< L S … D … D E
  bool connect_caustics;               ///< L S⁺ D E
  bool keep_caustic_deposits;          ///< where photons first meet a diffuse surface
  bool keep_indirect_deposits;         ///< where some do so again
  FootprintScale spread;               ///< of footprints; of caustics, never of what they light in turn
  PhotonTally& tally;
  CameraConnections& connections;
  const VcmTechniques* vcm = nullptr;  ///< null: photons carry no weights
  bool leave_walked = false;           ///< caustics of the manifold walk (see share.h) are made by others
};

/// Trace `ray()` and tell `arrive` what it met, again and again, until that says the photon has ended.
class LightPath {
 public:
  LightPath(const LightPathContext& context, const Emitter& emitter, const EmittedPhoton& photon, Sampler sampler);

  /// From its light on it carries the weights of the context's techniques. @param normal  as Emitter::emit says
  void carryWeights(const Emitter& emitter, vec3 normal) {
    trail_.begin(context_->vcm, emitter, state_.ray.origin, normal);
  }

  bool alive() const { return alive_; }
  const Ray& ray() const { return state_.ray; }
  void arrive(const RayHit& hit);

 private:
  enum class Stage : std::uint8_t { kEmitted, kSpecularChain, kAfterDiffuse };

  bool accounted() const { return stage_ != Stage::kAfterDiffuse; }
  /// What the photon carries.
  vec3 flux() const { return flux_ * state_.hero.weight; }
  void lose(LossReason reason, vec3 flux);
  void depart();
  // All of these say false if the photon ends.
  bool endStep();
  bool scatter();
  bool continueWith(const Bsdf& bsdf, vec3 specular_share, vec3 wo);
  bool scatterSpecular(const Bsdf& bsdf, vec3 carried, float p_class);
  void bendFootprint(const BsdfSample& s, float p_class);
  bool scatterDiffuse(const Bsdf& bsdf, float p_class, vec3 wo);
  bool leave(const BsdfSample& s);
  bool survives();
  bool staysUseful(float kept);
  void deposit(const Bsdf& bsdf, vec3 weighted, vec3 wo);
  void depositAgain(vec3 weighted);
  /// A caustic that others make.
  bool isLeft() const { return context_->leave_walked && stage_ == Stage::kSpecularChain && share_.isWalked(); }
  void connectToCamera(const Bsdf& bsdf, vec3 wo);
  VcmSurface surface() const { return VcmSurface::ofEncounter(encounter_, context_->world.options.specular_alpha); }

  const LightPathContext* context_;
  Ledger* ledger_;
  Sampler sampler_;
  PathState state_;
  Encounter encounter_;
  Stage stage_ = Stage::kEmitted;
  bool alive_ = true;
  bool deposits_again_ = false;  ///< was drawn to leave deposits after its first
  int bounce_ = 0;
  vec3 flux_;  ///< without the weight of its wavelengths
  vec3 emitted_;
  dvec3 roulette_{0.0};
  Footprint footprint_;
  VcmTrail trail_;
  ManifoldShare share_;
};

}  // namespace nephroid
