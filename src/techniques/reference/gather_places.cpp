#include "techniques/reference/gather_places.h"

#include <vector>

#include "core/parallel.h"
#include "techniques/reference/gathered_photons.h"
#include "techniques/reference/pilot.h"

namespace nephroid {
namespace {

/// One path each; far more than a light has blocks that can be told apart.
constexpr double kPixels = 16'384.0;
/// Places within reach of most: few of those that see a place as seldom as a third are missed.
constexpr float kWithinReach = 8.0F;

std::vector<GridPhoton> findPlaces(const CameraModel& camera, const PathTracer& tracer, const LayerNeeds& needs) {
  Film film(camera.width(), camera.height(), needs);
  std::vector<std::vector<vec3>> rows(static_cast<std::size_t>(film.height));
  parallelFor(rows.size(), [&](std::size_t row) {
    PathCounters counters;
    counters.gather_places = &rows[row];
    for (int x = 0; x < film.width; ++x) tracer.tracePath(x, static_cast<int>(row), 0, film, counters);
  });
  std::vector<GridPhoton> places;
  for (const std::vector<vec3>& row : rows)
    for (const vec3 position : row) places.push_back({.position = position, .dir = vec3(0.0F), .flux = vec3(0.0F)});
  return places;
}

}  // namespace

GatherPlaces::GatherPlaces(ReferenceWorld& world, const Camera& camera, int width, int height, const PathTracer& tracer,
                           const LayerNeeds& needs) {
  const PilotView view(world, camera, width, height, kPixels);
  const std::vector<GridPhoton> places = findPlaces(world.camera_model, tracer, needs);
  const float radius = chooseTypicalRadius(places, kWithinReach);
  if (radius > 0.0F) grid_ = PhotonGrid(places, radius);
}

bool GatherPlaces::isNear(vec3 position) const {
  bool found = false;
  grid_.visitNear(position, [&](const GridPhoton&) { found = true; });
  return found;
}

}  // namespace nephroid
