#include "techniques/reference/steering.h"

#include <algorithm>

namespace nephroid {
namespace {

constexpr std::uint64_t kMostBatchPasses = 4;
/// Rounds that gather the same photons at most: this part of all.
constexpr std::uint64_t kBatchShare = 8;

/// Those whose errors were asked for, and without a target those that steer: `beauty`, or else all.
std::vector<std::string> chooseLayers(const Film& film, const RenderSettings& settings, const LayerNeeds& needs,
                                      bool steers) {
  std::vector<std::string> layers = layersWithError(settings.layers, settings.target_error);
  if (settings.target_error > 0.0 || !steers) return layers;
  for (const std::string& layer : settings.layers) {
    const bool counts = needs.beauty ? layer == "beauty" : !planesOf(film, layer).empty();
    if (counts && std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
  }
  return layers;
}

}  // namespace

bool isTimedOnly(const RenderSettings& settings) {
  return settings.seconds > 0 && settings.samples == 0 && settings.photons == 0;
}

Steering::Steering(const Film& film, const RenderSettings& settings, const LayerNeeds& needs, bool adaptive)
    : settings_(settings),
      needs_(needs),
      adaptive_(adaptive),
      steers_(settings.target_error > 0.0 || (isTimedOnly(settings) && adaptive)),
      film_(film),
      errors_(film, chooseLayers(film, settings, needs, steers_)) {}

void Steering::watchGathering() {
  if (steers_ && !errors_.empty()) probe_.emplace(film_, needs_.beauty ? "beauty" : "specular");
}

void Steering::chooseBatches(std::uint64_t passes) {
  batch_passes_ = std::clamp<std::uint64_t>(passes / kBatches, 1, kMostBatchPasses);
}

void Steering::takePaths(const EyePasses& passes, bool gather) {
  if (probe_) probe_->takeRound(passes.done());
  if (errors_.empty() || gather) return;
  errors_.closeFullEyeBatches(passes.done(), batch_passes_);
  estimate();
}

void Steering::takePhotons(const EyePasses& passes, std::uint64_t batches, bool gathered) {
  if (errors_.empty()) return;
  errors_.closeFullLightBatch(batches);
  // Batches of photons are spread evenly with their neighbours as well: of two, the mean errs less than each says.
  // Where errors steer, they are to be known soon.
  const std::uint64_t together = steers_ || batch_passes_ == 1 ? 1 : 2;
  if (gathered) errors_.closeFullEyeBatches(passes.done(), together * batch_passes_);
  if (probe_) probe_->closeBatch();
  estimate();
}

void Steering::takeRest(const EyePasses& passes, std::uint64_t batches) {
  if (errors_.empty()) return;
  errors_.closeEyeBatches(passes.done());
  errors_.closeLightBatch(batches);
}

void Steering::estimate() {
  if (!steers_ || errors_.empty()) return;
  const bool by_picture = settings_.target_error <= 0.0 && needs_.beauty;
  error_ = by_picture ? ErrorEstimate::OfLayer{"beauty", errors_.relMse("beauty")} : errors_.worst();
  if (adaptive_ && errors_.eyeBatches() >= kFirstBatches) pass_variances_ = errors_.variancesOfPass(error_.layer);
}

bool Steering::reachesTarget() const {
  return settings_.target_error > 0.0 && isKnown() && error_.error.total() <= settings_.target_error;
}

bool Steering::mustGatherOn(std::uint64_t rounds_of_batch, std::uint64_t rounds) const {
  if (knowsWhatPays()) return rounds_of_batch < 1;
  if (batch_passes_ < kMostBatchPasses) return rounds_of_batch < batch_passes_;
  // The second four rounds may be gathered from three batches, by one, two and one of them. What pays is known after
  // two of these, unless the picture is still black.
  const std::uint64_t block = rounds / kMostBatchPasses, place = rounds % kMostBatchPasses;
  return block == 1 ? place == 2 : place != 0;
}

bool Steering::mayGatherOn(std::uint64_t rounds_of_batch, std::uint64_t rounds) const {
  return knowsWhatPays() && rounds_of_batch < std::max(batch_passes_, rounds / kBatchShare);
}

bool Steering::ungatheredPhotonsPay(std::uint64_t path_work, std::uint64_t light_rays) const {
  // Not where both are 0, as in a picture that is still black: then paths may find something.
  return isKnown() && error_.error.from_lights * static_cast<double>(path_work) >
                          error_.error.from_eye * static_cast<double>(light_rays);
}

bool Steering::photonsPay(const Work& work) const {
  const double path_work = static_cast<double>(work.path_work), light_rays = static_cast<double>(work.light_rays);
  const RelativeError& error = error_.error;
  if (!probe_) return error.from_lights * path_work >= error.from_eye * light_rays;
  const std::optional<GatherProbe::Parts> parts = probe_->parts();
  if (!parts || (isKnown() && error.from_eye <= 0.0)) return true;
  // What a batch adds to pixels that see it is noise of its own, in units of the probe.
  const double seen = isKnown() ? error.from_lights * (parts->paths + parts->photons) / error.from_eye : 0.0;
  const double rounds = static_cast<double>(work.rounds), batches = static_cast<double>(work.batches);
  const double of_batch = (parts->of_batch + seen * batches) * path_work / rounds;
  const double of_round = parts->paths * rounds * light_rays / batches;
  const auto n = static_cast<double>(work.rounds_of_batch);
  return n * (n + 1.0) * of_batch >= of_round;
}

void Steering::chooseRates(PathRates& rates) const {
  if (error_.layer == "beauty") rates.choose(pass_variances_, errors_.relativeScales(error_.layer));
}

void Steering::planRound(EyePasses& passes) const {
  if (pass_variances_.empty())
    passes.planAll();
  else
    passes.planWhereItPays(pass_variances_);
}

}  // namespace nephroid
