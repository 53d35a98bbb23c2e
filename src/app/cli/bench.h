// What `nephroid bench` measures and how it tells it.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_data.h"
#include "techniques/technique.h"

namespace nephroid::cli {

/// One quantity, measured once per repetition.
struct Measurement {
  std::string name;  ///< "rays/s", "load"
  std::string unit;  ///< "1/s", "s", "MiB", "" for a ratio
  std::vector<double> values;
};

/// All that was measured of one scene with one technique.
struct BenchResult {
  std::string scene, technique;
  std::vector<Measurement> measurements;
  std::string device;  ///< what computed: "cpu" or a device's name
};

/// Light tracing against plain rays (bench_light_tracing.cpp); empty where no light reaches anything that bends it.
std::vector<Measurement> measureLightTracingShare(const SceneData& scene, int repeats);

/// Middle value; the mean of the two middle ones of an even number. 0 of none.
double computeMedian(std::vector<double> values);

/// Half of the distance between the smallest and the largest value, relative to the median; 0 of fewer than two.
double computeSpread(const std::vector<double>& values);

}  // namespace nephroid::cli
