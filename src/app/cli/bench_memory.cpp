#include <sys/resource.h>

#include <fstream>
#include <string>

#include "app/cli/bench.h"

namespace nephroid::cli {

double readPeakMemory() {
  constexpr double kKibPerMib = 1024;
  // Unlike getrusage's maximum, this one is reset below, so that a scene does not inherit the peak of the one before.
  std::ifstream status("/proc/self/status");
  for (std::string key; status >> key;) {
    double kib = 0;
    if (key == "VmHWM:" && status >> kib) return kib / kKibPerMib;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / kKibPerMib;
}

void resetPeakMemory() {
  // proc(5): 5 resets the peak resident set size to the current one.
  std::ofstream("/proc/self/clear_refs") << "5";
}

}  // namespace nephroid::cli
