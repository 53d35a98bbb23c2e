#include "techniques/reference/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include "core/parallel.h"
#include "nephroid/error.h"
#include "nephroid/nephroid.h"
#include "scene/fingerprint.h"
#include "techniques/layers.h"
#include "techniques/reference/checkpoint.h"
#include "techniques/reference/continuation_pilot.h"
#include "techniques/reference/direction_pilot.h"
#include "techniques/reference/estimator.h"
#include "techniques/reference/gather_places.h"
#include "techniques/reference/geometry_layers.h"
#include "techniques/reference/guide_pilot.h"
#include "techniques/reference/path_tracer.h"
#include "techniques/reference/photon_batch.h"
#include "techniques/reference/steering.h"
#include "techniques/reference/vcm/vcm.h"
#include "techniques/settings.h"

namespace nephroid {
namespace {

/// Budgets when none is given: a few seconds for a picture of half a megapixel.
constexpr std::uint64_t kDefaultSamples = 32;
constexpr std::uint64_t kDefaultPhotons = 2'000'000;

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Are errors to be estimated of caustics alone, without the direct light beside which their blur counts for little?
bool estimatesCausticsAlone(const RenderSettings& settings) {
  const std::vector<std::string> layers = layersWithError(settings.layers, settings.target_error);
  return std::any_of(layers.begin(), layers.end(),
                     [](const std::string& layer) { return layer == "caustic" || layer == "irradiance_caustic"; });
}

/// One progressive render.
class ReferenceRender {
 public:
  ReferenceRender(const SceneData& scene, const Camera& camera, const RenderSettings& settings, ProgressSink* progress,
                  const StopToken* stop)
      : start_(Clock::now()),
        settings_(settings),
        progress_(progress),
        stop_(stop),
        camera_(camera),
        needs_(settings.layers),
        world_(scene, camera, settings.width, settings.height, makeOptions(settings)),
        film_(settings.width, settings.height, needs_),
        steering_(film_, settings, needs_,
                  settings.params.getBool("adaptive") && settings.params.getString("estimator") != "vcm"),
        choice_(chooseEstimators(settings.params.getString("estimator"), !estimatesCausticsAlone(settings), world_,
                                 camera, settings.width, settings.height, needs_)),
        path_needs_(choice_.caustic == Estimator::kVcm ? needs_.withoutCaustics() : needs_),
        path_tracer_(world_, path_needs_),
        passes_(settings.width, settings.height) {
    const bool connects_and_merges = choice_.caustic == Estimator::kVcm;
    if (connects_and_merges) checkVcm(scene, !steering_.empty());
    PhotonPaths from_photons = photonPathsOf(choice_);
    const bool gather_direct =
        choice_.caustic == Estimator::kPhotonMap && (needs_.caustic || needs_.irradiance_caustic);
    const bool gather_indirect = choice_.indirect == Estimator::kPhotonMap && (needs_.indirect || needs_.irradiance);
    const bool photons_reach_eye =
        gather_direct || gather_indirect || (from_photons.specular_caustic && needs_.throughSpecular());
    const bool gather = photons_reach_eye && !connects_and_merges;
    const PhotonPaths connect{
        .caustic = from_photons.caustic && !gather_direct && (needs_.caustic || needs_.anyIrradiance()),
        .indirect = from_photons.indirect && !gather_indirect && (needs_.indirect || needs_.irradiance)};
    if (connect.caustic || connect.indirect || photons_reach_eye)
      light_tracer_ = std::make_unique<LightTracer>(world_, connect);
    if (light_tracer_ && light_tracer_->emitters().empty()) light_tracer_.reset();
    gather_ = gather && light_tracer_;
    if (gather && !gather_) from_photons.specular_caustic = from_photons.specular_indirect = false;
    path_tracer_.leaveToPhotons(from_photons);
    PhotonPaths gathered;
    if (gather_) {
      gathered = {.caustic = gather_direct,
                  .indirect = gather_indirect,
                  .specular_caustic = needs_.throughSpecular(),
                  .specular_indirect = needs_.specular};
      light_tracer_->keepDeposits(gathered.indirect || gathered.specular_indirect);
      steering_.watchGathering();
      path_tracer_.gatherFrom(&gathered_, gathered);
    }
    if (choice_.caustic == Estimator::kManifold && light_tracer_) walkToLights();
    if (connects_and_merges && light_tracer_) vcm_ = std::make_unique<Vcm>(world_, *light_tracer_, needs_);
    if (light_tracer_) shareLedgers();
    if (settings.target_error > 0.0 && steering_.empty())
      throw UsageError("a target error needs a layer that converges, such as beauty; those asked for are exact");
    chooseBudgets();
    if (paysToMeasureContinuation())
      continuation_ = measureContinuation(world_, camera, settings.width, settings.height, path_needs_,
                                          {from_photons, connect, gathered});
    path_tracer_.continueBy(continuation_);
    if (paysToMeasureContinuation() && steering_.steers()) rates_.emplace(passes_.tiles(), continuation_);
    if (path_tracer_.mayDrawSeveralLightSamples()) penumbrae_.emplace(passes_.tiles());
    if (paysToLearnDirections()) {
      PathTracer learner(world_, path_needs_);
      learner.leaveToPhotons(from_photons);
      learner.continueBy(continuation_);
      directions_ = learnDirections(world_, camera, settings.width, settings.height, path_needs_, learner);
      path_tracer_.guideBy(directions_.empty() ? nullptr : &directions_);
    }
    addStage("build", secondsSince(start_));
  }

  RenderResult run() {
    RenderResult result;
    result.image.width = settings_.width, result.image.height = settings_.height;
    timed("geometry", [&] { geometry_ = renderGeometryLayers(world_, settings_.layers); });
    std::error_code unknown;  // then the file is not read, and writing it tells why
    if (std::filesystem::exists(settings_.checkpoint.path, unknown)) resume(result);
    Clock::time_point saved = Clock::now();
    while (!finished()) {
      if (stopped()) break;
      step();
      if (keepsCheckpoint() && secondsSince(saved) >= settings_.checkpoint.interval_s) {
        save(result);
        saved = Clock::now();
      }
      report();
    }
    result.interrupted = stopped();
    const bool nothing = (samples_budget_ > 0 && samples_done_ == 0) && (photons_budget_ == 0 || photons_done_ == 0);
    if (result.interrupted && nothing) throw InterruptedError("interrupted before there was anything to keep");
    if (keepsCheckpoint()) save(result);
    develop(result);
    describe(result);
    return result;
  }

 private:
  static ReferenceOptions makeOptions(const RenderSettings& settings) {
    ReferenceOptions options;
    options.specular_alpha = settings.params.getFloat("specular-alpha");
    options.max_bounces = settings.params.getInt("max-bounces");
    if (const int bands = settings.params.getInt("bands"); bands > 0) options.spectral.bands = makeBands(bands);
    options.seed = foldSeed(settings.seed);
    return options;
  }

  bool mayTraceMoreThan(std::uint64_t paths) const { return samples_budget_ > paths / passes_.tiles().pixels(); }

  /// The pilot takes 12 000 paths and 33 000 photons, which smaller renders would feel.
  bool paysToMeasureContinuation() const {
    constexpr std::uint64_t kFewestPaths = 1'000'000;
    return !vcm_ && needs_.beauty && mayTraceMoreThan(kFewestPaths);
  }

  /// The pilot takes 128 000 paths, and 384 000 where it finds that guiding pays.
  bool paysToLearnDirections() const {
    constexpr std::uint64_t kFewestPaths = 6'000'000;
    const bool wanted = settings_.params.getFloat("guiding") > 0.0F;
    return wanted && !vcm_ && needs_.beauty && path_needs_.beyondDiffuse() && mayTraceMoreThan(kFewestPaths);
  }

  void walkToLights() {
    manifold_ = std::make_unique<Manifold>(world_, light_tracer_->targets(), light_tracer_->emitters());
    path_tracer_.walkFrom(manifold_.get());
    light_tracer_->leaveWalkedCaustics();
  }

  void chooseBudgets() {
    const bool open_ended = isTimedOnly(settings_) || settings_.target_error > 0.0;
    constexpr std::uint64_t kUnlimited = std::uint64_t{1} << 62;
    samples_budget_ = settings_.samples ? settings_.samples : open_ended ? kUnlimited : kDefaultSamples;
    photons_budget_ = settings_.photons ? settings_.photons : open_ended ? kUnlimited : kDefaultPhotons;
    const bool caustics_from_eye = choice_.caustic != Estimator::kLight && choice_.caustic != Estimator::kFootprint;
    if (!needs_.eyeTraced(caustics_from_eye)) samples_budget_ = 0;
    if (!light_tracer_) photons_budget_ = 0;
    if (vcm_) {
      const auto pixels = static_cast<std::uint64_t>(settings_.width) * static_cast<std::uint64_t>(settings_.height);
      const auto schedule = VcmSchedule::choose(samples_budget_, open_ended ? 0 : photons_budget_, pixels);
      vcm_->setSchedule(schedule);
      makePhotonBatch(schedule.batch_photons);
    } else if (light_tracer_) {
      makePhotonBatch(chooseBatchPhotons(photons_budget_ < kUnlimited));
    }
    steering_.chooseBatches(samples_budget_);
  }

  /// Equal batches, so that each counts the same.
  std::uint32_t chooseBatchPhotons(bool limited) const {
    constexpr std::uint64_t kMax = PhotonBatch::kMaxPhotons;
    if (!limited) return kMax;
    const std::uint64_t fewest = steering_.empty() ? 1 : std::min(Steering::kBatches, photons_budget_);
    const std::uint64_t batches = std::max((photons_budget_ + kMax - 1) / kMax, fewest);
    return static_cast<std::uint32_t>((photons_budget_ + batches - 1) / batches);
  }
  void makePhotonBatch(std::uint32_t photons) {
    batch_photons_ = photons;
    photon_batch_ = std::make_unique<PhotonBatch>(*light_tracer_, photons, settings_.width, settings_.height);
    // A render that goes on comes here twice: what measures and teaches is emitted evenly each time.
    emitEvenly(*light_tracer_);
    if (choice_.caustic == Estimator::kFootprint && needs_.lightTraced())
      footprints_.apply(world_, *light_tracer_, *photon_batch_);
    guide();
    if (vcm_) vcm_->begin(*photon_batch_, settings_.width, settings_.height);
  }

  void guide() {
    constexpr std::uint64_t kFewestPaths = 1'000'000;  // for its pilot
    const GuideRequest request{photon_batch_->shares(), footprints_.overlaps, settings_.params.getFloat("guiding")};
    if (paysToGuide(choice_.caustic, needs_)) {
      guided_ = guideEmission(world_, *light_tracer_, request);
    } else if (gather_ && request.guided > 0.0F && mayTraceMoreThan(kFewestPaths)) {
      // Once: what later is learned of paths must not change where they are thought to end.
      if (!places_) places_.emplace(world_, camera_, settings_.width, settings_.height, path_tracer_, path_needs_);
      guided_ = guideToPlaces(world_, *light_tracer_, request, *places_);
    }
  }

  bool stopped() const { return stop_ && stop_->requested(); }
  bool timeIsUp() const { return settings_.seconds > 0 && secondsSince(start_) >= settings_.seconds; }
  bool samplesLeft() const { return samples_done_ < samples_budget_; }
  bool photonsLeft() const {
    return vcm_ ? batches_done_ < vcm_->batchesFor(samples_budget_) : photons_done_ < photons_budget_;
  }
  bool finished() const {
    if (!samplesLeft() && !photonsLeft()) return true;
    if (vcm_ && batches_done_ != vcm_->batchesFor(samples_done_)) return false;
    // Time may end a render only when every layer has something in it.
    const bool something = (samples_budget_ == 0 || samples_done_ > 0) && (photons_budget_ == 0 || photons_done_ > 0);
    if (!something) return false;
    if (settings_.target_error > 0.0) {
      // More of one direction alone need not ever lead to the target.
      const bool spent = (samples_budget_ > 0 && !samplesLeft()) || (photons_budget_ > 0 && !photonsLeft());
      if (spent || steering_.reachesTarget()) return true;
    }
    return timeIsUp();
  }

  /// One pass of whichever direction is behind.
  void step() {
    const Clock::time_point begin = Clock::now();
    if (photonsAreNext()) {
      tracePhotons();
      light_seconds_ += secondsSince(begin);
    } else {
      tracePaths();
      path_seconds_ += secondsSince(begin);
    }
  }
  bool photonsAreNext() const {
    if (vcm_) return batches_done_ < vcm_->batchesFor(samples_done_ + 1);
    if (!photonsLeft() || !samplesLeft()) return photonsLeft();
    // A round that was stopped goes on with the photons that it began with.
    if (passes_.planned()) return false;
    // What is gathered must have been emitted; otherwise the picture comes first.
    if (samples_done_ == 0) return gather_ && photons_done_ == 0;
    if (photons_done_ == 0) return true;
    if (steering_.steers() && (settings_.target_error > 0.0 || steering_.isKnown())) return photonsLessenError();
    if (settings_.seconds > 0) return light_seconds_ <= path_seconds_;
    return share(photons_done_, photons_budget_) <= share(samples_done_, samples_budget_);
  }
  bool photonsLessenError() const {
    if (gather_) {
      // Paths that gather the same photons over and over err alike.
      const std::uint64_t rounds = samples_done_ - samples_at_photons_;
      if (rounds == 0) return steering_.ungatheredPhotonsPay(path_work_, light_rays_);
      if (steering_.mustGatherOn(rounds, samples_done_)) return false;
      if (!steering_.mayGatherOn(rounds, samples_done_)) return true;
    }
    if (!steering_.knowsWhatPays())
      return share(photons_done_, kDefaultPhotons) <= share(samples_done_, kDefaultSamples);
    return steering_.photonsPay({.path_work = path_work_,
                                 .rounds = samples_done_,
                                 .light_rays = light_rays_,
                                 .batches = batches_done_,
                                 .rounds_of_batch = samples_done_ - samples_at_photons_});
  }

  static double share(std::uint64_t done, std::uint64_t budget) {
    return static_cast<double>(done) / static_cast<double>(budget);
  }

  /// A round of paths. If it is stopped, the tiles that are done are remembered, and the next call does the others.
  void tracePaths() {
    if (!passes_.planned()) {
      steering_.planRound(passes_);
      if (rates_) steering_.chooseRates(*rates_);
    }
    if (gather_ && batches_done_ > 0 && !gathered_.holds(batches_done_ - 1))
      gathered_.take(*photon_batch_, batches_done_ - 1);
    const bool something = samples_done_ > 0;
    // By tile, each of which is one thread's: a sum that all share would be passed to and fro at every path.
    struct Sum {
      std::uint64_t rays = 0, work = 0, not_finite = 0;
    };
    std::vector<Sum> sums(passes_.tiles().count());
    passes_.run(
        [&](int x, int y, std::uint32_t sample) {
          PathCounters counters;
          if (path_needs_.eyeTraced(!vcm_)) traceEyePath(x, y, sample, counters);
          if (vcm_) vcm_->tracePath(x, y, sample, film_, counters);
          Sum& sum = sums[passes_.tiles().tileOf(x, y)];
          sum.rays += counters.rays, sum.work += counters.work(), sum.not_finite += counters.not_finite;
          return counters.work();
        },
        [&] { return stopped() && something; });
    for (const Sum& sum : sums) path_rays_ += sum.rays, path_work_ += sum.work, not_finite_ += sum.not_finite;
    if (passes_.planned()) return;
    ++samples_done_;
    steering_.takePaths(passes_, gather_ && photonsLeft());
  }
  void traceEyePath(int x, int y, std::uint32_t sample, PathCounters& counters) {
    if (penumbrae_) counters.penumbrae = &*penumbrae_;
    if (!rates_) return path_tracer_.tracePath(x, y, sample, film_, counters);
    const std::size_t tile = passes_.tiles().tileOf(x, y);
    PartTally parts;
    counters.parts = &parts;
    path_tracer_.tracePath(x, y, sample, film_, counters, rates_->of(tile));
    rates_->note(tile, passes_.tiles().pixelOf(x, y), parts);
  }
  void tracePhotons() {
    if (vcm_) vcm_->prepareBatch(batches_done_);
    if (!photon_batch_->trace(batches_done_, [&] { return stopped(); })) return;
    if (vcm_) vcm_->takeBatch(batches_done_, *photon_batch_);
    photon_batch_->visitSplats([&](const Splat& splat, std::uint32_t pixel, std::span<const float> weights) {
      addSplat(splat, pixel, weights);
    });
    for (const PhotonBatch::Chunk& chunk : photon_batch_->chunks()) {
      ledgers_[chunk.emitter].add(chunk.tally.ledger);
      light_rays_ += chunk.tally.rays;
      not_finite_ += chunk.tally.not_finite;
      photons_done_ += static_cast<std::uint64_t>(chunk.tally.ledger.emitted_count);
    }
    ++batches_done_;
    steering_.takePhotons(passes_, batches_done_, gather_);
    samples_at_photons_ = samples_done_;
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

  bool keepsCheckpoint() const { return !settings_.checkpoint.path.empty(); }

  /// What must be the same where a render goes on. Budgets are not among it: a finished render can be given more.
  CheckpointFacts describeIdentity() const {
    CheckpointFacts facts{
        {"version", std::string(version())},
        {"scene", fmt::format("{:016x} by its content", fingerprintScene(world_.scene.scene()))},
        {"camera", fmt::format("{:016x} by its content", fingerprintCamera(camera_))},
        {"size", fmt::format("{}x{}", settings_.width, settings_.height)},
        {"seed", std::to_string(settings_.seed)},
        {"list of layers", fmt::format("{}", fmt::join(settings_.layers, ","))},
        {"list of estimated errors",
         fmt::format("{}", fmt::join(layersWithError(settings_.layers, settings_.target_error), ","))}};
    for (const ParamSpec& spec : settings_.params.specs())
      facts.emplace_back("parameter " + spec.name, settings_.params.toText(spec.name));
    return facts;
  }

  /// All that the next step depends on, to a writer or from a reader. Photons that are gathered are traced again.
  template <class State>
  void visitState(State& state) {
    state.value(batch_photons_);
    if (vcm_) vcm_->visitState(state);
    film_.visitPlanes([&](FilmPlane& plane) { state.values(plane.values()); });
    steering_.visitState(state);
    passes_.visitState(state);
    if (rates_) rates_->visitState(state);
    if (penumbrae_) penumbrae_->visitState(state);
    for (Ledger& ledger : ledgers_) ledger.visitState(state);
    for (std::uint64_t* count : {&samples_done_, &photons_done_, &batches_done_, &samples_at_photons_, &path_rays_,
                                 &path_work_, &light_rays_, &not_finite_})
      state.value(*count);
    gathered_.visitState(state);
    for (double* number : {&path_seconds_, &light_seconds_}) state.value(*number);
  }

  /// A full disk does not end a render: what is in memory is worth more than its copy.
  void save(RenderResult& result) {
    result.checkpoint_failure.clear();
    StateWriter state;
    visitState(state);
    try {
      writeCheckpoint(settings_.checkpoint.path, describeIdentity(), state.bytes());
    } catch (const ResourceError& error) {
      result.checkpoint_failure = error.what();
    }
  }

  /// @throws InputError
  void resume(RenderResult& result) {
    const std::vector<std::byte> bytes = readCheckpoint(settings_.checkpoint.path, describeIdentity());
    StateReader state(bytes);
    visitState(state);
    if (!state.isDone())
      throw InputError(
          fmt::format("{}: holds other sums than this render has; delete it to begin anew", settings_.checkpoint.path));
    if (light_tracer_) makePhotonBatch(batch_photons_);
    if ((gather_ || vcm_) && batches_done_ > 0) retraceBatches();
    steering_.estimate();
    result.notes.push_back(fmt::format("went on from {} with {} samples, {:.1f} M photons", settings_.checkpoint.path,
                                       samples_done_, static_cast<double>(photons_done_) * 1e-6));
  }

  /// Those that the next step depends on.
  void retraceBatches() {
    const std::uint64_t last = batches_done_ - 1;
    if (gather_) {
      // Not stopped: what is saved at the end must know of them.
      for (const std::uint64_t batch : gathered_.batchesToRetake()) {
        photon_batch_->trace(batch, [] { return false; });
        gathered_.retake(*photon_batch_, batch);
      }
      if (gathered_.holds(last)) return;
    }
    if (vcm_) vcm_->prepareBatch(last);
    if (photon_batch_->trace(last, [&] { return stopped(); }) && vcm_) vcm_->takeBatch(last, *photon_batch_);
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
    std::string status =
        fmt::format("{} samples, {:.1f} M photons", samples_done_, static_cast<double>(photons_done_) * 1e-6);
    if (settings_.target_error > 0.0 && steering_.isKnown()) {
      const auto& [layer, error] = steering_.error();
      // The error falls with the inverse of the work.
      fraction = std::max(fraction, settings_.target_error / error.total());
      status = fmt::format("{} relMSE {:.2g}, {}", layer, error.total(), status);
    }
    progress_->update(std::min(fraction, 1.0), status);
  }

  /// From sums to pictures.
  void develop(RenderResult& result) {
    steering_.takeRest(passes_, batches_done_);
    for (const std::string& name : settings_.layers) {
      const auto geometry =
          std::find_if(geometry_.begin(), geometry_.end(), [&](const Layer& l) { return l.name == name; });
      if (geometry != geometry_.end())
        result.image.layers.push_back(std::move(*geometry));
      else if (const std::string_view erring = erringLayer(name); !erring.empty())
        result.image.layers.push_back({name, steering_.errors().standardError(erring, passes_.done(), batches_done_)});
      else
        result.image.layers.push_back({name, developLayer(film_, name, {passes_, batches_done_})});
    }
  }

  void describe(RenderResult& result) {
    for (std::size_t e = 0; e < ledgers_.size(); ++e) {
      if (ledgers_[e].emitted_count > 0) ledgers_[e].scale(1.0 / static_cast<double>(ledgers_[e].emitted_count));
      result.ledgers.push_back(ledgers_[e]);
    }
    addStage("path tracing", path_seconds_);
    addStage("light tracing", light_seconds_);
    result.stats.stages = stages_;
    result.stats.rays = path_rays_ + light_rays_;
    result.stats.photons = photons_done_;
    result.stats.samples = passes_.meanPasses();
    result.stats.not_finite = not_finite_;
    auto& metadata = result.image.metadata;
    metadata["technique"] = "reference";
    metadata["device"] = "cpu";
    metadata["seed"] = std::to_string(settings_.seed);
    metadata["samples"] = std::to_string(passes_.meanPasses());
    metadata["photons"] = std::to_string(photons_done_);
    for (const std::string& layer : layersWithError(settings_.layers, settings_.target_error)) {
      const RelativeError error = steering_.errors().relMse(layer);
      const std::string key = "estimated_relmse." + layer;
      metadata[key] = fmt::format("{:.4g}", error.total());
      metadata[key + ".from_eye"] = fmt::format("{:.4g}", error.from_eye);
      metadata[key + ".from_lights"] = fmt::format("{:.4g}", error.from_lights);
    }
    for (const ParamSpec& spec : settings_.params.specs())
      metadata["set." + spec.name] = settings_.params.toText(spec.name);
    describeEstimators(choice_, needs_, metadata);
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
    if (const float into = continuation_.probability[1]; into < 1.0F)
      result.notes.push_back(
          fmt::format("{:.0f} % of the paths go on from surfaces that they met by mirrors or glass: more bring little",
                      100.0F * into));
    if (const float lesser = continuation_.lesser_way; lesser < 1.0F)
      result.notes.push_back(fmt::format(
          "{:.0f} % of the lesser ways at clear glass are followed, such as what it mirrors: more bring little",
          100.0F * lesser));
    if (!directions_.empty())
      result.notes.emplace_back(
          "paths go on from diffuse surfaces towards what light came from in a pilot: half of them, where that pays");
    for (const GuidedLight& light : guided_)
      result.notes.push_back(fmt::format("photons of '{}' guided: {:.0f} % of them are of use, {:.0f} % if even",
                                         light.name, 100.0 * light.seen_guided, 100.0 * light.seen_even));
    for (std::string& sentence : explainEstimators(choice_)) result.notes.push_back(std::move(sentence));
    if (any_delta && vcm_ && needs_.specular)
      result.notes.emplace_back(
          "light of sources without a size that returns through mirrors or glass after two or more diffuse bounces is "
          "missing: estimator=vcm does not gather it");
    if (any_delta && choice_.specular_caustic == Estimator::kPath && needs_.throughSpecular())
      result.notes.emplace_back(
          "caustics in mirrors and through glass, and what they light in turn, are missing under lights without a "
          "size: give them extras.radius or extras.angle");
    if (any_delta && choice_.caustic == Estimator::kPath && needs_.caustic)
      result.notes.emplace_back("estimator=path finds no caustic of lights without a size");
    if (!layersWithError(settings_.layers, settings_.target_error).empty() && steering_.errors().batches() < 2)
      result.notes.emplace_back("standard errors are infinite: they take two batches at least; raise the budget");
    if (needs_.specular_caustic_bias && !gather_ && !vcm_)
      result.notes.emplace_back("specular_caustic_bias is black: nothing is gathered under a kernel");
    const bool gathers_seen = choice_.caustic == Estimator::kPhotonMap || vcm_;
    if (needs_.caustic_bias && !(gathers_seen && light_tracer_))
      result.notes.emplace_back("caustic_bias is black: only photon-map and vcm gather caustics seen directly");
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
  Camera camera_;
  LayerNeeds needs_;
  ReferenceWorld world_;
  Film film_;
  Steering steering_;
  EstimatorChoice choice_;
  LayerNeeds path_needs_;  ///< of `path_tracer_`
  Continuation continuation_;
  DirectionGuide directions_;
  PathTracer path_tracer_;
  std::unique_ptr<LightTracer> light_tracer_;
  std::unique_ptr<Manifold> manifold_;
  FootprintSpread footprints_;
  std::optional<GatherPlaces> places_;
  std::vector<GuidedLight> guided_;
  std::unique_ptr<PhotonBatch> photon_batch_;
  std::unique_ptr<Vcm> vcm_;
  std::vector<Ledger> ledgers_;
  std::vector<Layer> geometry_;
  std::vector<StageTime> stages_;
  EyePasses passes_;
  std::optional<PathRates> rates_;
  std::optional<PenumbraFinder> penumbrae_;
  bool gather_ = false;
  GatheredPhotons gathered_;
  std::uint64_t samples_budget_ = 0, photons_budget_ = 0, samples_done_ = 0, photons_done_ = 0, batches_done_ = 0;
  std::uint64_t path_rays_ = 0, path_work_ = 0, light_rays_ = 0, not_finite_ = 0;
  std::uint64_t samples_at_photons_ = 0;
  std::uint32_t batch_photons_ = 0;  ///< asked of a batch
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
      "path tracing and light tracing on the CPU, progressive: unbiased but for caustics, whose footprints shrink, and "
      "for what is seen of them and of what they light in mirrors and through glass, whose kernels shrink; the truth "
      "for all others";
  technique.source = "Kajiya 1986; Arvo 1986; Veach 1997; Igehy 1999; Knaus & Zwicker 2011";
  technique.is_progressive = true;
  technique.params = {
      makeSpecularAlphaParam(),
      {"max-bounces", 64, 1, 1024, "", "scattering events on a path before it is given up", {}},
      makeEstimatorParam(),
      {"adaptive",
       true,
       0,
       0,
       "",
       "where --target-error or --seconds alone end the render: more paths where the picture is noisiest, after some "
       "everywhere; false: as many everywhere",
       {}},
      makeGuidingParam(),
      {"bands", 0, 0, 64, "", "wavelength bands of dispersive light; 0: continuous", {}},
  };
  technique.render = renderReference;
  return technique;
}

}  // namespace nephroid
