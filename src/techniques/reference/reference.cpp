#include "techniques/reference/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>

#include "core/parallel.h"
#include "nephroid/error.h"
#include "techniques/layers.h"
#include "techniques/reference/estimator.h"
#include "techniques/reference/geometry_layers.h"
#include "techniques/reference/path_tracer.h"
#include "techniques/reference/photon_batch.h"
#include "techniques/settings.h"

namespace nephroid {
namespace {

/// Photons under the first kernel, were they spread evenly: fewer is noise, more is blur.
constexpr float kGatherPhotons = 10.0F;
/// Share of the photons that a shrinking kernel keeps; 2/3 balances bias and variance (Knaus & Zwicker 2011).
constexpr double kRadiusAlpha = 2.0 / 3.0;
/// Budgets when none is given: a few seconds for a picture of half a megapixel.
constexpr std::uint64_t kDefaultSamples = 32;
constexpr std::uint64_t kDefaultPhotons = 2'000'000;

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// One progressive render.
class ReferenceRender {
 public:
  ReferenceRender(const SceneData& scene, const Camera& camera, const RenderSettings& settings, ProgressSink* progress,
                  const StopToken* stop)
      : start_(Clock::now()),
        settings_(settings),
        progress_(progress),
        stop_(stop),
        estimator_(chooseEstimator(settings.params.getString("estimator"))),
        needs_(settings.layers),
        world_(scene, camera, settings.width, settings.height, makeOptions(settings)),
        film_(settings.width, settings.height, needs_),
        path_tracer_(world_, needs_) {
    const bool from_lights = world_.options.light_tracing;
    const bool gather_direct = estimator_ == Estimator::kPhotonMap && (needs_.caustic || needs_.irradiance_caustic);
    const bool gather = from_lights && (gather_direct || needs_.throughSpecular());
    if ((from_lights && needs_.lightTraced()) || gather)
      light_tracer_ = std::make_unique<LightTracer>(world_, needs_.indirect || needs_.irradiance, gather);
    if (light_tracer_ && light_tracer_->emitters().empty()) light_tracer_.reset();
    gather_ = gather && light_tracer_;
    if (gather_) path_tracer_.gatherFrom(&caustics_, gather_direct);
    if (light_tracer_ && gather_direct) light_tracer_->leaveCausticsToGathering();
    if (light_tracer_) shareLedgers();
    chooseBudgets();
    addStage("build", secondsSince(start_));
  }

  RenderResult run() {
    RenderResult result;
    result.image.width = settings_.width, result.image.height = settings_.height;
    timed("geometry", [&] { geometry_ = renderGeometryLayers(world_, settings_.layers); });
    while (!finished()) {
      if (stopped()) break;
      step();
      report();
    }
    result.interrupted = stopped();
    const bool nothing = (samples_budget_ > 0 && samples_done_ == 0) && (photons_budget_ == 0 || photons_done_ == 0);
    if (result.interrupted && nothing) throw InterruptedError("interrupted before there was anything to keep");
    develop(result);
    describe(result);
    return result;
  }

 private:
  static ReferenceOptions makeOptions(const RenderSettings& settings) {
    ReferenceOptions options;
    options.specular_alpha = settings.params.getFloat("specular-alpha");
    options.max_bounces = settings.params.getInt("max-bounces");
    options.light_tracing = chooseEstimator(settings.params.getString("estimator")) != Estimator::kPath;
    if (const int bands = settings.params.getInt("bands"); bands > 0) options.spectral.bands = makeBands(bands);
    options.seed = foldSeed(settings.seed);
    return options;
  }

  void chooseBudgets() {
    const bool timed_only = settings_.seconds > 0 && settings_.samples == 0 && settings_.photons == 0;
    constexpr std::uint64_t kUnlimited = std::uint64_t{1} << 62;
    samples_budget_ = settings_.samples ? settings_.samples : timed_only ? kUnlimited : kDefaultSamples;
    photons_budget_ = settings_.photons ? settings_.photons : timed_only ? kUnlimited : kDefaultPhotons;
    const bool caustics_from_eye = estimator_ == Estimator::kPath || estimator_ == Estimator::kPhotonMap;
    if (!needs_.eyeTraced(caustics_from_eye)) samples_budget_ = 0;
    if (!light_tracer_) photons_budget_ = 0;
    if (light_tracer_) makePhotonBatch(photons_budget_ < kUnlimited);
  }

  /// Equal batches, so that each counts the same.
  void makePhotonBatch(bool limited) {
    constexpr std::uint64_t kMax = PhotonBatch::kMaxPhotons;
    const std::uint64_t batches = limited ? (photons_budget_ + kMax - 1) / kMax : 1;
    const std::uint64_t photons = limited ? (photons_budget_ + batches - 1) / batches : kMax;
    photon_batch_ = std::make_unique<PhotonBatch>(*light_tracer_, static_cast<std::uint32_t>(photons), settings_.width,
                                                  settings_.height);
    if (estimator_ == Estimator::kFootprint && needs_.lightTraced())
      footprints_.apply(world_, *light_tracer_, *photon_batch_);
  }

  bool stopped() const { return stop_ && stop_->requested(); }
  bool timeIsUp() const { return settings_.seconds > 0 && secondsSince(start_) >= settings_.seconds; }
  bool samplesLeft() const { return samples_done_ < samples_budget_; }
  bool photonsLeft() const { return photons_done_ < photons_budget_; }
  bool finished() const {
    if (!samplesLeft() && !photonsLeft()) return true;
    // Time may end a render only when every layer has something in it.
    const bool something = (samples_budget_ == 0 || samples_done_ > 0) && (photons_budget_ == 0 || photons_done_ > 0);
    return something && timeIsUp();
  }

  /// One pass of whichever direction is behind: by time if time is the budget, else by share of its budget.
  void step() {
    bool photons = photonsLeft();
    if (photons && samplesLeft()) {
      // What is gathered must have been emitted; otherwise the picture comes first.
      if (samples_done_ == 0)
        photons = gather_ && photons_done_ == 0;
      else if (photons_done_ > 0)
        photons = settings_.seconds > 0
                      ? light_seconds_ <= path_seconds_
                      : share(photons_done_, photons_budget_) <= share(samples_done_, samples_budget_);
    }
    const Clock::time_point begin = Clock::now();
    if (photons) {
      tracePhotons();
      light_seconds_ += secondsSince(begin);
    } else {
      tracePaths();
      path_seconds_ += secondsSince(begin);
    }
  }
  static double share(std::uint64_t done, std::uint64_t budget) {
    return static_cast<double>(done) / static_cast<double>(budget);
  }

  /// One sample per pixel. Pixels are independent, so the order of tiles does not matter.
  void tracePaths() {
    const auto sample = static_cast<std::uint32_t>(samples_done_);
    std::vector<PathCounters> rows(static_cast<std::size_t>(settings_.height));
    std::atomic<bool> complete{true};
    parallelFor(static_cast<std::size_t>(settings_.height), [&](std::size_t row) {
      const int y = static_cast<int>(row);
      if (stopped() && samples_done_ > 0) {
        complete = false;
        return;
      }
      for (int x = 0; x < settings_.width; ++x) path_tracer_.tracePath(x, y, sample, film_, rows[y]);
    });
    // A pass that was cut short has some rows more than others: those rows know it by the pass count they are divided
    // by.
    if (!complete) {
      partial_rows_.assign(static_cast<std::size_t>(settings_.height), false);
      for (int y = 0; y < settings_.height; ++y) partial_rows_[y] = rows[y].rays > 0;
      return;
    }
    for (const PathCounters& row : rows) rays_ += row.rays, not_finite_ += row.not_finite;
    ++samples_done_;
  }

  void tracePhotons() {
    if (!photon_batch_->trace(batches_done_, [&] { return stopped(); })) return;
    photon_batch_->visitSplats([&](const Splat& splat, std::uint32_t pixel, std::span<const float> weights) {
      addSplat(splat, pixel, weights);
    });
    for (const PhotonBatch::Chunk& chunk : photon_batch_->chunks()) {
      ledgers_[chunk.emitter].add(chunk.tally.ledger);
      rays_ += chunk.tally.rays;
      not_finite_ += chunk.tally.not_finite;
      photons_done_ += static_cast<std::uint64_t>(chunk.tally.ledger.emitted_count);
    }
    ++batches_done_;
    if (!gather_) return;
    std::vector<GridPhoton> deposits;
    for (PhotonBatch::Chunk& chunk : photon_batch_->chunks()) {
      for (GridPhoton& photon : chunk.tally.deposits) {
        photon.flux *= photon_batch_->scaleOf(chunk);
        deposits.push_back(photon);
      }
    }
    replaceCaustics(deposits);
  }

  /// The photons of the latest batch, under a kernel that shrinks from batch to batch (Knaus & Zwicker 2011, eq. 15):
  /// the mean over batches then converges although each batch is blurred.
  void replaceCaustics(const std::vector<GridPhoton>& deposits) {
    if (deposits.empty()) return;
    if (first_radius_ == 0.0F) {
      first_radius_ = chooseGatherRadius(deposits, kGatherPhotons);
      radius_squared_ = static_cast<double>(first_radius_) * first_radius_;
    } else {
      const double k = static_cast<double>(batches_done_ - 1);
      radius_squared_ *= (k + kRadiusAlpha) / (k + 1.0);
    }
    const auto radius = static_cast<float>(std::sqrt(radius_squared_));
    caustics_ = radius > 0.0F ? PhotonGrid(deposits, radius) : PhotonGrid();
  }

  void addSplat(const Splat& splat, std::uint32_t pixel, std::span<const float> weights) {
    const auto addTo = [&](FilmPlane& plane, vec3 value) {
      if (!plane.active()) return;
      for (std::size_t i = 0; i < weights.size(); ++i) plane.add(pixel + i, value * weights[i]);
    };
    addTo(splat.is_caustic ? film_.caustic : film_.indirect, splat.radiance);
    addTo(film_.irradiance, splat.irradiance);
    if (splat.is_caustic) addTo(film_.irradiance_caustic, splat.irradiance);
  }

  void shareLedgers() {
    for (const auto& emitter : light_tracer_->emitters()) {
      ledgers_.emplace_back();
      ledgers_.back().light = emitter->name();
    }
  }

  void report() {
    if (!progress_) return;
    double fraction = 0.0;
    if (settings_.seconds > 0) fraction = secondsSince(start_) / settings_.seconds;
    double by_budget = 0.0;
    int budgets = 0;
    if (samples_budget_ > 0) by_budget += share(samples_done_, samples_budget_), ++budgets;
    if (photons_budget_ > 0) by_budget += share(photons_done_, photons_budget_), ++budgets;
    if (budgets > 0) fraction = std::max(fraction, by_budget / budgets);
    progress_->update(std::min(fraction, 1.0), fmt::format("{} samples, {:.1f} M photons", samples_done_,
                                                           static_cast<double>(photons_done_) * 1e-6));
  }

  /// From sums to pictures.
  void develop(RenderResult& result) {
    for (const std::string& name : settings_.layers) {
      const auto geometry =
          std::find_if(geometry_.begin(), geometry_.end(), [&](const Layer& l) { return l.name == name; });
      if (geometry != geometry_.end())
        result.image.layers.push_back(std::move(*geometry));
      else
        result.image.layers.push_back({name, developLayer(name)});
    }
  }

  Image developLayer(std::string_view name) const {
    struct Part {
      std::string_view layer;
      const FilmPlane* from_eye;
      const FilmPlane* from_lights;
    };
    const Part parts[] = {{"emission", &film_.emission, nullptr},
                          {"direct", &film_.direct, nullptr},
                          {"caustic", &film_.caustic_from_eye, &film_.caustic},
                          {"specular", &film_.specular, nullptr},
                          {"indirect", &film_.indirect_from_eye, &film_.indirect},
                          {"specular_caustic", &film_.specular_caustic, nullptr},
                          {"irradiance", &film_.irradiance_from_eye, &film_.irradiance},
                          {"irradiance_caustic", &film_.irradiance_caustic_from_eye, &film_.irradiance_caustic}};
    Image image(settings_.width, settings_.height, 3);
    const double by_batches = batches_done_ > 0 ? 1.0 / static_cast<double>(batches_done_) : 0.0;
    for (std::size_t pixel = 0; pixel < image.pixels.size() / 3; ++pixel) {
      const std::size_t row = pixel / static_cast<std::size_t>(settings_.width);
      const std::uint64_t samples = samples_done_ + (!partial_rows_.empty() && partial_rows_[row] ? 1 : 0);
      const double by_samples = samples > 0 ? 1.0 / static_cast<double>(samples) : 0.0;
      vec3 sum(0.0F);
      for (const Part& part : parts) {
        const bool summed = name == "beauty" && findLayerInfo(part.layer).summed;
        if (part.layer != name && !summed) continue;
        // Each layer is rounded to float before the sum, so that the files' layers add up to the files' beauty.
        dvec3 value(0.0);
        if (part.from_eye->active()) value += part.from_eye->at(pixel) * by_samples;
        if (part.from_lights && part.from_lights->active()) value += part.from_lights->at(pixel) * by_batches;
        sum += vec3(value);
      }
      image.setRgb(static_cast<int>(pixel % settings_.width), static_cast<int>(row), sum);
    }
    return image;
  }

  void describe(RenderResult& result) {
    for (std::size_t e = 0; e < ledgers_.size(); ++e) {
      if (ledgers_[e].emitted_count > 0) ledgers_[e].scale(1.0 / static_cast<double>(ledgers_[e].emitted_count));
      result.ledgers.push_back(ledgers_[e]);
    }
    addStage("path tracing", path_seconds_);
    addStage("light tracing", light_seconds_);
    result.stats.stages = stages_;
    result.stats.rays = rays_;
    result.stats.photons = photons_done_;
    result.stats.samples = samples_done_;
    result.stats.not_finite = not_finite_;
    auto& metadata = result.image.metadata;
    metadata["technique"] = "reference";
    metadata["device"] = "cpu";
    metadata["seed"] = std::to_string(settings_.seed);
    metadata["samples"] = std::to_string(samples_done_);
    metadata["photons"] = std::to_string(photons_done_);
    for (const ParamSpec& spec : settings_.params.specs())
      metadata["set." + spec.name] = settings_.params.toText(spec.name);
    describeEstimators(estimator_, needs_, metadata);
    addNotes(result);
  }

  void addNotes(RenderResult& result) const {
    bool any_delta = false;
    for (const Light& light : world_.scene.scene().lights)
      any_delta = any_delta || (light.kind == LightKind::kSun ? light.angle_deg == 0.0F : light.radius == 0.0F);
    for (std::size_t e = 0; e < footprints_.overlaps.size(); ++e)
      result.notes.push_back(
          fmt::format("caustics of '{}': each photon spread over its footprint, overlap {:g} N^(1/3)",
                      light_tracer_->emitters()[e]->name(), footprints_.overlaps[e]));
    if (any_delta && (needs_.specular || needs_.specular_caustic))
      result.notes.emplace_back(gather_ || !light_tracer_
                                    ? "light of sources without a size that returns through mirrors or glass after two "
                                      "or more diffuse bounces is missing"
                                    : "caustics in mirrors and through glass are missing under lights without a size: "
                                      "give them extras.radius or extras.angle");
    if (any_delta && !world_.options.light_tracing && needs_.caustic)
      result.notes.emplace_back("estimator=path finds no caustic of lights without a size");
    if (not_finite_ > 0)
      result.notes.push_back(fmt::format("{} path contributions were not finite and were dropped", not_finite_));
  }

  void addStage(std::string name, double seconds) { stages_.push_back({std::move(name), seconds}); }
  template <class Work>
  void timed(std::string name, Work&& work) {
    const Clock::time_point begin = Clock::now();
    work();
    addStage(std::move(name), secondsSince(begin));
  }

  Clock::time_point start_;
  const RenderSettings& settings_;
  ProgressSink* progress_;
  const StopToken* stop_;
  Estimator estimator_;
  LayerNeeds needs_;
  ReferenceWorld world_;
  Film film_;
  PathTracer path_tracer_;
  std::unique_ptr<LightTracer> light_tracer_;
  FootprintSpread footprints_;
  std::unique_ptr<PhotonBatch> photon_batch_;
  std::vector<Ledger> ledgers_;
  std::vector<Layer> geometry_;
  std::vector<StageTime> stages_;
  std::vector<bool> partial_rows_;
  bool gather_ = false;
  PhotonGrid caustics_;
  float first_radius_ = 0.0F;
  double radius_squared_ = 0.0;
  std::uint64_t samples_budget_ = 0, photons_budget_ = 0, samples_done_ = 0, photons_done_ = 0, batches_done_ = 0;
  std::uint64_t rays_ = 0, not_finite_ = 0;
  double path_seconds_ = 0, light_seconds_ = 0;
};

RenderResult renderReference(const SceneData& scene, const Camera& camera, const RenderSettings& settings,
                             ProgressSink* progress, const StopToken* stop) {
  checkDevice(findTechnique("reference"), settings.device);
  if (settings.width < 1 || settings.height < 1) throw UsageError("a picture has at least 1 × 1 pixels");
  RenderResult result;
  runWithThreads(settings.threads > 0 ? settings.threads : availableThreads(),
                 [&] { result = ReferenceRender(scene, camera, settings, progress, stop).run(); });
  return result;
}

}  // namespace

Technique makeReferenceTechnique() {
  Technique technique;
  technique.name = "reference";
  technique.text =
      "path tracing and light tracing on the CPU, progressive: unbiased but for caustics in mirrors and through glass, "
      "whose kernels shrink; the truth for all others";
  technique.source = "Kajiya 1986; Arvo 1986; Veach 1997; Knaus & Zwicker 2011";
  technique.params = {
      makeSpecularAlphaParam(),
      {"max-bounces", 64, 1, 1024, "", "scattering events on a path before it is given up", {}},
      makeEstimatorParam(),
      {"bands", 0, 0, 64, "", "wavelength bands of dispersive light; 0: continuous", {}},
  };
  technique.render = renderReference;
  return technique;
}

}  // namespace nephroid
