#include "app/cli/memory.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <fstream>
#include <limits>
#include <string>

#include "nephroid/error.h"

namespace nephroid::cli {
namespace {

constexpr double kKibPerMib = 1024;

/// The number after `key` in a file of "key: value kB" lines; negative if it has none.
double readEntry(const char* path, const std::string& key) {
  std::ifstream file(path);
  double kib = -1;
  for (std::string word; file >> word;)
    if (word == key && file >> kib) return kib;
  return -1;
}

}  // namespace

double readPeakMemory() {
  // Unlike getrusage's maximum, this one is reset below, so that a scene does not inherit the peak of the one before.
  const double kib = readEntry("/proc/self/status", "VmHWM:");
  if (kib >= 0) return kib / kKibPerMib;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / kKibPerMib;
}

void resetPeakMemory() {
  // proc(5): 5 resets the peak resident set size to the current one.
  std::ofstream("/proc/self/clear_refs") << "5";
}

double readAvailableMemory() {
  const double kib = readEntry("/proc/meminfo", "MemAvailable:");
  return kib >= 0 ? kib / kKibPerMib : std::numeric_limits<double>::infinity();
}

void checkMemory(double needed, double available) {
  if (needed <= available) return;
  throw ResourceError(fmt::format(
      "the picture needs at least {:.0f} MiB, {:.0f} MiB are free; lower --size or the number of --aov layers", needed,
      available));
}

}  // namespace nephroid::cli
