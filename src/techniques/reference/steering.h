// What estimated errors decide in a progressive render: when it is good enough, whether paths or photons are next, and
// where the paths go.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "techniques/reference/error_estimate.h"
#include "techniques/reference/eye_passes.h"
#include "techniques/reference/film.h"
#include "techniques/reference/gather_probe.h"
#include "techniques/reference/path_rates.h"
#include "techniques/technique.h"

namespace nephroid {

class Steering {
 public:
  /// Batches that a budget is cut into where errors are estimated: the relative error of a standard error from B
  /// batches is 1/√(2(B − 1)), here 18 %.
  static constexpr std::uint64_t kBatches = 16;

  /// @param film      must outlive it
  /// @param settings  ditto. A target, or time alone, lets errors steer
  /// @param adaptive  passes from the eye may go where errors are large
  Steering(const Film& film, const RenderSettings& settings, const LayerNeeds& needs, bool adaptive);

  /// Paths gather photons: from here on, before any, it is measured whose noise theirs is.
  void watchGathering();
  /// Nobody asked for errors, and nothing is steered by them.
  bool empty() const { return errors_.empty(); }
  /// Errors decide what is next, at the latest once they are known.
  bool steers() const { return steers_; }
  const ErrorEstimate& errors() const { return errors_; }

  /// Passes in the first batches from the eye. Points of the sampler are well spread together, so that a mean over them
  /// errs less than the spread of single ones says: batches of four know of that.
  /// @param passes  of the whole render
  void chooseBatches(std::uint64_t passes);
  std::uint64_t batchPasses() const { return batch_passes_; }

  /// After a round of paths. @param gather  the same photons as the next: batches are closed by takePhotons(). Else
  /// they are closed where they are long enough
  void takePaths(const EyePasses& passes, bool gather);
  /// After a batch of photons. @param gathered  paths gathered those before: passes that gathered the same batch belong
  /// into one batch of theirs
  void takePhotons(const EyePasses& passes, std::uint64_t batches, bool gathered);
  /// At the end: nothing is left out of the estimate.
  void takeRest(const EyePasses& passes, std::uint64_t batches);
  /// From what is in closed batches, which a checkpoint may have brought.
  void estimate();

  /// Of fewer batches, even the mean over a picture is unsure.
  bool isKnown() const { return errors_.batches() >= kFirstBatches; }
  /// Are these, or at least whose noise it is that is gathered?
  bool knowsWhatPays() const { return isKnown() || (probe_ && probe_->parts()); }
  /// Of the layer that steers, at the last closed batches.
  const ErrorEstimate::OfLayer& error() const { return error_; }
  bool reachesTarget() const;
  /// May one more round of paths gather the photons of the latest batch? Some must, and each time about an eighth more,
  /// so that there are batches enough to know the error by.
  bool mayGatherOn(std::uint64_t rounds_of_batch, std::uint64_t rounds) const;
  /// Do photons lessen the error more than paths that gather the latest batch would, even if no path gathers it?
  bool ungatheredPhotonsPay(std::uint64_t path_work, std::uint64_t light_rays) const;
  /// Have so few rounds gathered them that another one is due, whatever pays? One, once it is known what pays. Before
  /// that most batches serve as many rounds as a batch from the eye has passes, and some early ones fewer, so that
  /// pairs of passes that gathered one batch can be held against such that gathered two.
  /// @param rounds  in all
  bool mustGatherOn(std::uint64_t rounds_of_batch, std::uint64_t rounds) const;
  /// What was done so far.
  struct Work {
    std::uint64_t path_work = 0, rounds = 0;  ///< of paths: see PathCounters
    std::uint64_t light_rays = 0, batches = 0;
    std::uint64_t rounds_of_batch = 0;  ///< that gathered the latest
  };
  /// Do photons lessen the error more by another ray? A variance falls by its share per pass, and a pass costs rays.
  /// Where paths gather, a batch is to serve as many rounds n as all the others, for it counts by them: with V_e the
  /// variance of a round, V_g of a batch and c their costs, (V_e + n V_g)(c_e + c_g/n) is least for n² = V_e c_g/(V_g
  /// c_e). Rays, not seconds: equal renders must take equal steps.
  bool photonsPay(const Work& work) const;
  void planRound(EyePasses& passes) const;
  /// What it knows of the layer that steers is for `rates` as well.
  void chooseRates(PathRates& rates) const;

  template <class State>
  void visitState(State& state) {
    errors_.visitState(state);
    if (probe_) probe_->visitState(state);
  }

 private:
  static constexpr std::uint64_t kFirstBatches = 8;

  const RenderSettings& settings_;
  const LayerNeeds& needs_;
  bool adaptive_, steers_;
  const Film& film_;
  ErrorEstimate errors_;
  ErrorEstimate::OfLayer error_;
  std::optional<GatherProbe> probe_;
  std::vector<double> pass_variances_;  ///< of that layer, by tile; empty until they are known
  std::uint64_t batch_passes_ = 1;
};

/// Does nothing but time end the render?
bool isTimedOnly(const RenderSettings& settings);

}  // namespace nephroid
