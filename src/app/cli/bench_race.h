// Error over CPU time of each estimator of the reference, and how `nephroid bench --race` tells it.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/cli/technique_options.h"

namespace nephroid::cli {

struct RaceOptions {
  TechniqueOptions technique;           ///< size, seed, threads, parameters; `estimator=` among them races alone
  std::string reference, mask;          ///< files; empty: a long render of its own, all pixels
  std::uint64_t reference_photons = 0;  ///< of its own reference
  double seconds = 0;                   ///< CPU time after which an estimator gets no longer render
};

/// One render.
struct RacePoint {
  double cpu_s = 0;  ///< user and system, all threads, from loading the scene to the finished file
  std::uint64_t photons = 0, samples = 0;
  double nrmse = 0, l1 = 0, relmse = 0;
};

/// The renders of one estimator, each of twice the photons of the one before.
struct RaceCurve {
  std::string estimator;
  std::vector<RacePoint> points;
};

struct RaceResult {
  std::string scene;
  std::vector<RaceCurve> curves;
};

/// Renders direct, caustic and specular, and compares direct + caustic.
/// @throws InputError, UsageError, ResourceError; InterruptedError if the program was asked to stop
RaceResult runRace(const std::string& scene, const RaceOptions& options);

std::string formatRace(const RaceResult& result);
nlohmann::ordered_json raceToJson(const RaceResult& result);
/// A drawing: a row for each scene, a panel for each figure, a curve for each estimator, both axes logarithmic.
std::string drawRace(const std::vector<RaceResult>& results);

}  // namespace nephroid::cli
