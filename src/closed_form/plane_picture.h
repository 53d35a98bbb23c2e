// What a technique says about an irradiance that a formula also knows.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"
#include "scene/scene_data.h"
#include "techniques/ledger.h"
#include "techniques/technique.h"

namespace nephroid::closed_form {

/// A rectangle of a plane, seen squarely by an orthographic camera that stands just off it.
///
/// Rays of an orthographic camera begin at its own plane, so that whatever hangs over the receiver is behind the camera
/// and hides nothing: the picture is the irradiance on the receiver, W/m², pixel by pixel.
struct PlaneView {
  vec3 centre{0.0F};      ///< of the rectangle, on the plane
  vec3 normal{0, 1, 0};   ///< unit, out of the lit side
  vec3 up{0, 0, -1};      ///< unit, in the plane: towards row 0. Columns run along up × normal
  double distance = 0.0;  ///< of the camera from the plane, m: less than the gap to whatever is over it
  double width = 1.0;     ///< m; pixels are square, so the height is width · rows / columns
  int columns = 512, rows = 512;

  double pixelSize() const { return width / columns; }
  double height() const { return pixelSize() * rows; }
  Camera camera() const;
};

struct PlanePicture {
  PlaneView view;
  Image irradiance;  ///< irradiance_caustic
  std::vector<Ledger> ledgers;
  RenderStats stats;

  /// W per channel on the whole rectangle.
  dvec3 flux() const;
  /// Mean over each column, one channel.
  std::vector<double> columnMeans(int channel = 0) const;
  std::vector<double> rowMeans(int channel = 0) const;
  /// Whether no pixel has any light.
  bool isBlack() const;
  /// Flux-weighted mean distance from the picture's centre, m, one channel.
  double meanRadius(int channel = 0) const;
  /// Mean over rings about the picture's centre, one channel: pixels belong to the ring that holds their centre.
  std::vector<double> ringMeans(double radius, std::size_t rings, int channel = 0) const;
};

/// How to render a view.
struct PlaneRender {
  std::string technique{"reference"};
  RenderSettings settings;              ///< budgets, seed, device, parameters; without these, the technique's defaults
  std::vector<std::string> parameters;  ///< "key=value", on top of those
  ProgressSink* progress = nullptr;
  const StopToken* stop = nullptr;
};

/// The caustic's irradiance. By the reference the same for any number of threads.
PlanePicture renderPlane(const SceneData& scene, const PlaneView& view, PlaneRender render);
/// Likewise by the reference's photons.
PlanePicture renderPlane(const SceneData& scene, const PlaneView& view, std::uint64_t photons, std::uint64_t seed = 1,
                         const std::vector<std::string>& parameters = {});

/// Renders a view in whatever way its owner has chosen.
/// @param parameters  "key=value" that the closed form itself needs, such as a number of bands
using PlaneRenderer = std::function<PlanePicture(const SceneData& scene, const PlaneView& view,
                                                 const std::vector<std::string>& parameters)>;

/// The worst of the ledgers' residuals: everything emitted is found again if it is at most 1e-5.
double worstResidual(const std::vector<Ledger>& ledgers);

/// A sun of unit irradiance. @param dir unit, along its light
Light makeSun(vec3 dir, float angle_deg = 0.0F);

}  // namespace nephroid::closed_form
