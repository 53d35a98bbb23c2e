// How fast a technique draws a scene, and how `nephroid bench` tells it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/cli/technique_options.h"
#include "scene/scene_data.h"
#include "techniques/technique.h"

namespace nephroid::cli {

struct SpeedOptions {
  TechniqueOptions technique;
  int warmup = 1, repeats = 5;  ///< renders
};

/// One quantity, measured once per repetition.
struct Measurement {
  std::string name;  ///< "rays/s", "load"
  std::string unit;  ///< "1/s", "s", "MiB", "" for a ratio
  std::vector<double> values;
};

/// All that was measured of one scene with one technique.
struct SpeedResult {
  std::string scene, technique;
  std::vector<Measurement> measurements;
  std::string device;  ///< what computed: "cpu" or a device's name
};

/// Renders the scene again and again; stops early, with half a result, when the program is asked to stop.
/// @throws InputError, UsageError, DeviceError, ResourceError
SpeedResult measureSpeed(const std::string& scene, const Technique& technique, const SpeedOptions& options);

/// A table of medians and spreads.
std::string formatSpeed(const SpeedResult& result);
/// With every value.
nlohmann::ordered_json speedToJson(const SpeedResult& result);

/// Light tracing against plain rays (bench_light_tracing.cpp); empty where no light reaches anything that bends it.
std::vector<Measurement> measureLightTracingShare(const SceneData& scene, int repeats);

/// Middle value; the mean of the two middle ones of an even number. 0 of none.
double computeMedian(std::vector<double> values);

/// Half of the distance between the smallest and the largest value, relative to the median; 0 of fewer than two.
double computeSpread(const std::vector<double>& values);

}  // namespace nephroid::cli
