#include "techniques/reference/pilot.h"

#include <cmath>

#include "core/parallel.h"
#include "techniques/reference/error_estimate.h"

namespace nephroid {
namespace {

constexpr std::uint32_t kPilotSeed = 0x9110700DU;

CameraModel smallCamera(const Camera& camera, int width, int height, double pixels) {
  const double scale = std::sqrt(pixels / (static_cast<double>(width) * height));
  const auto scaled = [&](int side) { return std::max(1, static_cast<int>(std::lround(side * scale))); };
  return {camera, scaled(width), scaled(height)};
}

}  // namespace

PilotView::PilotView(ReferenceWorld& world, const Camera& camera, int width, int height, double pixels)
    : world_(world), camera_(world.camera_model), seed_(world.options.seed) {
  world.camera_model = smallCamera(camera, width, height, pixels);
  world.options.seed = kPilotSeed;
}

PilotView::~PilotView() {
  world_.camera_model = camera_;
  world_.options.seed = seed_;
}

double tracePilotPass(const PathTracer& tracer, std::uint32_t pass, Film& film, std::span<PartTally> parts) {
  std::vector<PathCounters> rows(static_cast<std::size_t>(film.height));
  parallelFor(rows.size(), [&](std::size_t row) {
    for (int x = 0; x < film.width; ++x) {
      if (!parts.empty()) rows[row].parts = &parts[row * static_cast<std::size_t>(film.width) + x];
      tracer.tracePath(x, static_cast<int>(row), pass, film, rows[row]);
    }
  });
  double rays = 0.0;
  for (const PathCounters& row : rows) rays += static_cast<double>(row.rays);
  return rays;
}

std::vector<dvec3> blurPilot(const std::vector<dvec3>& picture, int width, int height) {
  std::vector<dvec3> blurred;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      dvec3 sum(0.0);
      int count = 0;
      for (int j = std::max(0, y - 2); j <= std::min(height - 1, y + 2); ++j)
        for (int i = std::max(0, x - 2); i <= std::min(width - 1, x + 2); ++i, ++count)
          sum += picture[static_cast<std::size_t>(j) * width + i];
      blurred.push_back(sum / static_cast<double>(count));
    }
  }
  return blurred;
}

double pilotFloor(const std::vector<dvec3>& picture) {
  double brightness = 0.0;
  for (const dvec3& value : picture) brightness += value.x + value.y + value.z;
  return kRelativeFloor * brightness / (3.0 * static_cast<double>(picture.size()));
}

}  // namespace nephroid
