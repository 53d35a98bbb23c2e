#include "techniques/reference/footprint_splat.h"

#include <algorithm>
#include <cmath>

namespace nephroid {
namespace {

/// Least half-axis of a kernel times the cube root of the photons, pixels: half a pixel at 100 000.
constexpr double kLeastRadius = 25.0;
/// Up to so many photons per pixel of the picture, spreading takes more noise away than it adds blur.
constexpr double kPayingPhotonsPerPixel = 64.0;
/// Height of the kernel over its radius, as in gathering photons: curved ground counts, other walls do not.
constexpr float kFlatness = 0.3F;
/// Kernels are sampled at this many points at least along their shortest radius, up to kMostSteps a pixel.
constexpr float kLeastPoints = 1.5F;
constexpr int kMostSteps = 4;

/// Does the pixel see the plane on which the photon ended?
bool counts(const ReceiverView& view, const FootprintSplat& s, int x, int y) {
  const ReceiverView::Seen& seen = view.at(x, y);
  if (seen.instance == s.instance && std::abs(dot(s.normal, seen.position) - s.plane) <= s.thickness) return true;
  return static_cast<std::uint32_t>(y * view.width() + x) == s.splat.pixel;
}

}  // namespace

FootprintScale scaleFootprints(float overlap, std::uint32_t photons, std::uint64_t batch, std::size_t pixels) {
  const double count = static_cast<double>(photons) * static_cast<double>(batch + 1);
  const double narrower = std::cbrt(count);
  const double beyond = 1.0 + count / (kPayingPhotonsPerPixel * static_cast<double>(pixels));
  return {static_cast<float>(overlap / (narrower * narrower * beyond * beyond)),
          static_cast<float>(kLeastRadius / (narrower * beyond))};
}

std::optional<FootprintSplat> makeFootprintSplat(const Footprint& footprint, const FootprintScale& scale,
                                                 const CameraModel& camera, const SurfacePoint& point, vec2 film) {
  if (!footprint.valid() || scale.cell <= 0.0F) return std::nullopt;
  FootprintShape c = footprint.shapeOf(scale.cell, [&](vec3 axis) { return camera.filmOffset(point.position, axis); });
  const float floor = scale.least_radius_px * scale.least_radius_px;
  c.xx += floor, c.yy += floor;
  if (!std::isfinite(c.trace())) return std::nullopt;
  const float middle = 0.5F * c.trace(), spread = c.spread();
  const float shrink = std::min(1.0F, kMostFootprintRadius * kMostFootprintRadius / (middle + spread));
  c.xx *= shrink, c.xy *= shrink, c.yy *= shrink;
  const float determinant = c.determinant();
  if (!(determinant > 0.0F)) return std::nullopt;
  FootprintSplat s;
  s.film = film;
  s.place_share = std::sqrt(c.place * shrink), s.direction_share = std::sqrt(c.direction * shrink);
  s.reach = vec2(std::sqrt(c.xx), std::sqrt(c.yy));
  s.xx = c.yy / determinant, s.xy = -c.xy / determinant, s.yy = c.xx / determinant;
  const float shortest = std::sqrt(std::max((middle - spread) * shrink, 1e-6F));
  s.steps = std::clamp(static_cast<int>(std::ceil(kLeastPoints / shortest)), 1, kMostSteps);
  s.instance = point.instance;
  s.normal = point.normal_geometric;
  s.plane = dot(point.normal_geometric, point.position);
  // On the receiver: as long as the kernel's axis is there.
  const FootprintAxes axes = footprint.axes();
  float squared = 0.0F;
  for (int k = 0; k < 2; ++k)
    squared += c.place * dot(axes.place[k], axes.place[k]) + c.direction * dot(axes.direction[k], axes.direction[k]);
  s.thickness = kFlatness * std::sqrt(squared * shrink) + 4.0F * point.position_error;
  return s;
}

bool weighFootprintRow(const ReceiverView& view, const FootprintSplat& s, int y, FootprintRow& row) {
  row.y = y;
  row.x_first = std::max(static_cast<int>(std::floor(s.film.x - s.reach.x)), 0);
  row.x_end = std::min(static_cast<int>(std::floor(s.film.x + s.reach.x)), view.width() - 1) + 1;
  if (row.x_first >= row.x_end) return false;
  std::fill_n(row.weights.begin(), row.x_end - row.x_first, 0.0F);
  const auto steps = static_cast<float>(s.steps);
  const int last_point = (row.x_end - row.x_first) * s.steps - 1;
  bool any = false;
  for (int j = 0; j < s.steps; ++j) {
    const float dy = static_cast<float>(y) + (static_cast<float>(j) + 0.5F) / steps - s.film.y;
    // r² < 1 between the roots of a parabola in dx.
    const float along = s.xy * dy, discriminant = along * along - s.xx * (s.yy * dy * dy - 1.0F);
    if (!(discriminant > 0.0F)) continue;
    const float half = std::sqrt(discriminant) / s.xx, middle = -along / s.xx;
    const float left = static_cast<float>(row.x_first) - s.film.x;
    const auto pointAt = [&](float dx) { return (dx - left) * steps - 0.5F; };
    const int first = std::max(static_cast<int>(std::ceil(pointAt(middle - half))), 0);
    const int last = std::min(static_cast<int>(std::floor(pointAt(middle + half))), last_point);
    for (int i = first; i <= last; ++i) {
      const float dx = left + (static_cast<float>(i) + 0.5F) / steps - middle;
      row.weights[static_cast<std::size_t>(i / s.steps)] += s.xx * (half * half - dx * dx);
    }
    any = any || first <= last;
  }
  if (!any) return false;
  for (int x = row.x_first; x < row.x_end; ++x) {
    float& weight = row.weights[static_cast<std::size_t>(x - row.x_first)];
    weight = weight > 0.0F && counts(view, s, x, y) ? weight * s.weight_scale : 0.0F;
  }
  return true;
}

bool normalizeFootprint(const ReceiverView& view, FootprintSplat& s) {
  s.weight_scale = 1.0F;
  float sum = 0.0F;
  int pixels = 0;
  visitFootprint(view, s, 0, view.height(), [&](const FootprintRow& row) {
    for (int x = row.x_first; x < row.x_end; ++x) {
      const float weight = row.weights[static_cast<std::size_t>(x - row.x_first)];
      sum += weight;
      pixels += weight > 0.0F ? 1 : 0;
    }
  });
  if (pixels < 2 || !(sum > 0.0F)) return false;
  s.weight_scale = 1.0F / sum;
  return true;
}

}  // namespace nephroid
