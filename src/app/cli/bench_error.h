// How far the caustics of a technique are from the reference's, and how `nephroid bench --error` tells it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/technique_options.h"
#include "techniques/technique.h"

namespace nephroid::cli {

struct ErrorOptions {
  TechniqueOptions technique;           ///< whose size, seed and threads are the reference's, too
  std::uint64_t reference_photons = 0;  ///< >= 2
};

/// The layer `caustic` of the reference: the mean of two renders with random numbers of their own.
struct CausticReference {
  SceneData scene;
  Image caustic;  ///< of all photons
  Image half;     ///< of half of them
  std::vector<Ledger> ledgers;
};

/// The share of a reason in the flux that meets what bends light.
struct LostShare {
  std::string reason;
  double share = 0;
};

/// Of the layer `caustic` of one scene.
struct ErrorResult {
  std::string scene, technique, device;
  double relmse = 0, flip = 0;
  double energy = 0;                      ///< sum over the reference's sum; NaN if both are 0
  std::optional<double> lost;             ///< share of all reasons; nothing where the technique keeps no ledger
  std::vector<LostShare> lost_by_reason;  ///< those above 0
};

/// @throws InputError, ResourceError; InterruptedError if the program was asked to stop
CausticReference renderCausticReference(const std::string& scene, const ErrorOptions& options);

/// What noise alone makes of each figure: half of the reference's photons against all. With relMSE it is just the noise
/// of the reference: (A − (A + B)/2)² = ((A − B)/2)² has the variance of the mean of A and B as its expectation.
ErrorResult measureNoise(const std::string& scene, const CausticReference& reference);

/// Renders with the technique and compares.
/// @throws UsageError, DeviceError, ResourceError; InterruptedError if the program was asked to stop
ErrorResult measureError(const std::string& scene, const Technique& technique, const CausticReference& reference,
                         const ErrorOptions& options);

/// @param scenes  whose names fit the first column
std::string formatErrorHeader(const std::vector<std::string>& scenes, const ErrorOptions& options);
std::string formatErrorRow(const std::vector<std::string>& scenes, const ErrorResult& result);
nlohmann::ordered_json errorToJson(const ErrorResult& result);

}  // namespace nephroid::cli
