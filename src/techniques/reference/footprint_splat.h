// A photon spread over the pixels that see the plane on which it ended.
//
// The kernel is Epanechnikov's, 1 − r², over the ellipse that is the footprint's image. Where it is narrow it is
// summed over a raster of points within each pixel, so that a footprint smaller than a pixel counts for that pixel
// alone. Weights add up to one over the pixels that count: those that see the same plane of the same instance, and the
// photon's own. So flux is kept, at edges as well.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "techniques/reference/footprint.h"
#include "techniques/reference/photon_tally.h"
#include "techniques/reference/receiver_view.h"

namespace nephroid {

/// How far footprints spread.
struct FootprintScale {
  /// Share of a light's emission domain over which one photon is spread: an overlap of K photons is K over their
  /// number. 0: not at all.
  float cell = 0.0F;
  /// Ellipses are no narrower than this on the picture, pixels: what a fold has no width in.
  float least_radius_px = 0.0F;
  /// As `cell`, of photons that are gathered where they ended (see gathered_photons.h). 0: they have no footprint.
  float gathered_cell = 0.0F;

  bool any() const { return cell > 0.0F || gathered_cell > 0.0F; }
};

/// For batch number `batch` (from 0) of a light that emits `photons` in each. Of N photons in all, one is spread over
/// `overlap`·N^(1/3) cells of the emission domain: kernels narrow as N^(−1/6) while more and more of them overlap, so
/// blur, which is second order in their width, and noise vanish at the same rate N^(−1/3). Once every pixel has many
/// photons of its own, kernels narrow much faster, and what is left is the noise of those, N^(−1/2).
/// @param pixels  of the picture
FootprintScale scaleFootprints(float overlap, std::uint32_t photons, std::uint64_t batch, std::size_t pixels);

/// The kernel of a footprint on the picture, but for `splat` and `weight_scale`; nothing if it cannot be spread.
/// @param film  where the photon's end is seen, pixels
std::optional<FootprintSplat> makeFootprintSplat(const Footprint& footprint, const FootprintScale& scale,
                                                 const CameraModel& camera, const SurfacePoint& point, vec2 film);

/// Fills in `weight_scale`; `splat` must be there. @return false if only the photon's own pixel counts
bool normalizeFootprint(const ReceiverView& view, FootprintSplat& splat);

/// r² of a place on the film, in half-axes of the kernel.
inline float squaredRadiusAt(const FootprintSplat& s, vec2 film) {
  const vec2 d = film - s.film;
  return (s.xx * d.x + 2.0F * s.xy * d.y) * d.x + s.yy * d.y * d.y;
}

/// First and last row that the kernel may reach.
inline int firstRowOf(const FootprintSplat& s) { return static_cast<int>(std::floor(s.film.y - s.reach.y)); }
inline int lastRowOf(const FootprintSplat& s) { return static_cast<int>(std::floor(s.film.y + s.reach.y)); }

/// Half a kernel is never longer, pixels: where a straight line is a poor guess, and work is wasted.
inline constexpr float kMostFootprintRadius = 24.0F;

/// The weights of one row of pixels.
struct FootprintRow {
  int y = 0, x_first = 0, x_end = 0;
  std::array<float, 2 * static_cast<std::size_t>(kMostFootprintRadius) + 4> weights;  ///< from x_first on
};
/// @return false if the row is empty
bool weighFootprintRow(const ReceiverView& view, const FootprintSplat& splat, int y, FootprintRow& row);

/// Calls `visit(row)` for rows [row_begin, row_end) of the picture. Weights of all rows sum to 1; some may be 0.
template <class Visit>
void visitFootprint(const ReceiverView& view, const FootprintSplat& s, int row_begin, int row_end, Visit&& visit) {
  const int first = std::max(firstRowOf(s), row_begin), last = std::min(lastRowOf(s), row_end - 1);
  FootprintRow row;
  for (int y = first; y <= last; ++y)
    if (weighFootprintRow(view, s, y, row)) visit(row);
}

}  // namespace nephroid
