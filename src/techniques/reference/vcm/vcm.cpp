#include "techniques/reference/vcm/vcm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "nephroid/error.h"

namespace nephroid {
namespace {

/// Photons under the first kernel, of as many as a batch may have, were they spread evenly: fewer is noise, more is
/// blur. It does not depend on how a budget is cut into passes, for kernels shrink so slowly that the first tells much.
constexpr float kFirstGather = 10.0F;
/// Pixels under the first kernel, at most: where each has a photon a pass, they gather as many. Light far off must not
/// widen kernels beyond what the picture resolves.
constexpr float kFirstPixels = 10.0F;
/// α of Eq. 19: how slowly kernels shrink. The paper's choice; squared radii fall as i^(−1/4).
constexpr double kAlpha = 0.75;
/// Photons that measure how large the lit ground is.
constexpr std::uint32_t kPilotPhotons = 1U << 14;
/// Fewest photons of a pass whose number is free: pictures may be tiny.
constexpr std::uint64_t kLeastPassPhotons = 1U << 12;

template <class Vertex>
void append(std::vector<Vertex>& all, const std::vector<Vertex>& some, float scale) {
  for (Vertex vertex : some) {
    vertex.flux *= scale;
    all.push_back(vertex);
  }
}

/// Half of the photons that the camera could see lie on ground of which a pixel shows less, m²; infinite if it sees
/// none.
float medianPixelArea(const CameraModel& camera, const std::vector<GridPhoton>& photons) {
  std::vector<float> areas;
  for (const GridPhoton& photon : photons)
    if (const auto seen = camera.connect(photon.position)) areas.push_back(1.0F / seen->importance);
  if (areas.empty()) return kInfinity;
  const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
  std::nth_element(areas.begin(), middle, areas.end());
  return *middle;
}

std::vector<VcmPhoton> collectPhotons(const PhotonBatch& batch) {
  std::vector<VcmPhoton> photons;
  for (const PhotonBatch::Chunk& chunk : batch.chunks()) append(photons, chunk.tally.vcm_photons, batch.scaleOf(chunk));
  return photons;
}

}  // namespace

VcmSchedule VcmSchedule::choose(std::uint64_t passes, std::uint64_t photons, std::uint64_t pixels) {
  constexpr std::uint64_t kMax = PhotonBatch::kMaxPhotons;
  const auto divideUp = [](std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; };
  if (photons == 0) return {1, static_cast<std::uint32_t>(std::clamp(pixels, kLeastPassPhotons, kMax))};
  const std::uint64_t per_pass = divideUp(photons, passes), batches = divideUp(per_pass, kMax);
  return {batches, static_cast<std::uint32_t>(divideUp(per_pass, batches))};
}

void Vcm::begin(const PhotonBatch& batch, int width, int height) {
  PhotonBatch pilot(tracer_, kPilotPhotons, width, height);
  VcmTechniques unweighted(world_, tracer_.emitters(), pilot.shares(), tracer_.targets());
  tracer_.carryWeights(&unweighted);
  pilot.trace(0, [] { return false; });
  std::vector<GridPhoton> ends;
  for (const VcmPhoton& photon : collectPhotons(pilot)) ends.push_back({photon.position, photon.dir, photon.flux});
  techniques_ = std::make_unique<VcmTechniques>(world_, tracer_.emitters(), batch.shares(), tracer_.targets());
  first_radius_ =
      chooseGatherRadius(ends, kFirstGather * unweighted.photons() / static_cast<float>(PhotonBatch::kMaxPhotons));
  first_radius_ = std::min(first_radius_, std::sqrt(kFirstPixels * medianPixelArea(world_.camera_model, ends) / kPi));
  tracer_.carryWeights(techniques_.get());
}

void Vcm::prepareBatch(std::uint64_t batch) {
  const auto pass = static_cast<double>(batch / batches_per_pass_ + 1);
  techniques_->setRadius(static_cast<float>(first_radius_ * std::sqrt(std::pow(pass, kAlpha - 1.0))));
}

void Vcm::takeBatch(std::uint64_t batch, const PhotonBatch& photons) {
  if ((batch + 1) % batches_per_pass_ != 0) return;
  const float radius = techniques_->radius();
  photons_ = {};
  if (radius > 0.0F) photons_.grid = BasicPhotonGrid<VcmPhoton>(collectPhotons(photons), radius);
  for (const PhotonBatch::Chunk& chunk : photons.chunks()) {
    append(photons_.rough, chunk.tally.vcm_rough, photons.scaleOf(chunk));
    append(photons_.ends, chunk.tally.vcm_ends, photons.scaleOf(chunk));
  }
}

void checkVcm(const SceneData& scene, bool estimates_errors) {
  if (estimates_errors)
    throw UsageError(
        "estimator=vcm knows no standard errors, for its techniques share photons; choose another for --target-error "
        "and *_error");
  for (const Material& material : scene.materials)
    if (material.dispersion > 0.0F && material.isSolidDielectric())
      throw UsageError(
          fmt::format("estimator=vcm does not follow wavelengths, and '{}' is dispersive; choose another estimator",
                      material.name));
}

}  // namespace nephroid
