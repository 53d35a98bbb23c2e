#include "techniques/reference/continuation_pilot.h"

#include <optional>
#include <vector>

#include "techniques/reference/light_tracer.h"
#include "techniques/reference/photon_batch.h"
#include "techniques/reference/pilot.h"

namespace nephroid {
namespace {

/// As many of each as the pilot of estimators takes, for the same reasons.
constexpr std::uint32_t kBatches = 8, kBatchPhotons = 4096, kPassesPerBatch = 4;
constexpr double kPasses = kBatches * kPassesPerBatch;

/// A small render with all that `beauty` is made of.
class SmallRender {
 public:
  SmallRender(const ReferenceWorld& world, const LayerNeeds& needs, const PhotonShare& share)
      : light_tracer_(world, share.connect),
        path_tracer_(world, needs),
        film_(world.camera_model.width(), world.camera_model.height(), needs),
        parts_(pixels()),
        from_eye_(pixels()) {
    light_tracer_.keepDeposits(share.gathered.indirect || share.gathered.specular_indirect);
    path_tracer_.leaveToPhotons(share.left);
    path_tracer_.gatherFrom(&gathered_, share.gathered);
    std::optional<PhotonBatch> batch;
    if (!light_tracer_.emitters().empty()) batch.emplace(light_tracer_, kBatchPhotons, film_.width, film_.height);
    for (std::uint32_t i = 0; i < kBatches; ++i) {
      if (batch) take(*batch, i);
      for (std::uint32_t pass = 0; pass < kPassesPerBatch; ++pass) {
        tracePilotPass(path_tracer_, i * kPassesPerBatch + pass, film_, parts_);
        from_eye_.close([&](std::size_t pixel) { return sumAt(&LayerPlanes::from_eye, pixel); });
      }
    }
  }

  Continuation choose() const {
    std::vector<dvec3> picture;
    for (std::size_t pixel = 0; pixel < pixels(); ++pixel)
      picture.push_back(from_eye_.meanAt(pixel) + sumAt(&LayerPlanes::from_lights, pixel) / (1.0 * kBatches));
    const std::vector<dvec3> truth = blurPilot(picture, film_.width, film_.height);
    const double floor = pilotFloor(truth);
    PartTally sum;
    double variance = 0.0;
    for (std::size_t pixel = 0; pixel < pixels(); ++pixel) {
      const double brightness = (truth[pixel].x + truth[pixel].y + truth[pixel].z) / 3.0;
      const double scale = brightness * brightness + floor * floor;
      if (scale <= 0.0) continue;
      const dvec3 of_mean = from_eye_.varianceOfMeanAt(pixel);
      variance += kPasses * kPasses * (of_mean.x + of_mean.y + of_mean.z) / scale;
      sum.add(parts_[pixel], 1.0 / scale, 1.0);
    }
    return chooseContinuation(sum, variance);
  }

 private:
  std::size_t pixels() const { return static_cast<std::size_t>(film_.width) * static_cast<std::size_t>(film_.height); }
  void take(PhotonBatch& batch, std::uint32_t index) {
    batch.trace(index, [] { return false; });
    batch.visitSplats([&](const Splat& splat, std::uint32_t pixel, std::span<const float> weights) {
      FilmPlane& plane = splat.is_caustic ? film_.caustic : film_.indirect;
      if (!plane.active()) return;
      for (std::size_t k = 0; k < weights.size(); ++k) plane.add(pixel + k, splat.radiance * weights[k]);
    });
    gathered_.take(batch, index);
  }
  dvec3 sumAt(const FilmPlane* LayerPlanes::*direction, std::size_t pixel) const {
    dvec3 sum(0.0);
    for (const LayerPlanes& planes : planesOf(film_, "beauty"))
      if (planes.*direction && (planes.*direction)->active()) sum += (planes.*direction)->at(pixel);
    return sum;
  }

  LightTracer light_tracer_;
  GatheredPhotons gathered_;
  PathTracer path_tracer_;
  Film film_;
  std::vector<PartTally> parts_;  ///< by pixel
  PilotSpread from_eye_;
};

}  // namespace

Continuation measureContinuation(ReferenceWorld& world, const Camera& camera, int width, int height,
                                 const LayerNeeds& needs, const PhotonShare& share) {
  const PilotView view(world, camera, width, height);
  return SmallRender(world, needs, share).choose();
}

}  // namespace nephroid
