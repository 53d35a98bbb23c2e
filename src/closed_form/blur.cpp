#include "closed_form/blur.h"

#include <algorithm>
#include <cmath>

#include "closed_form/optics.h"
#include "closed_form/profile.h"
#include "scene/builtin/setting.h"
#include "scene/builtin/shapes.h"

namespace nephroid::closed_form {

double edgeSpread(double u) {
  const double v = std::clamp(u, -1.0, 1.0);
  return 0.5 + (std::asin(v) + v * std::sqrt(1.0 - v * v)) / kPiD;
}

double blurRadius(const BlurCase& c) {
  return c.distance * std::tan(std::asin(std::sin(radiansD(0.5 * c.angle_deg)) / c.ior));
}

double edgeWidth() {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) (edgeSpread(0.5 * (low + high)) < 0.9 ? low : high) = 0.5 * (low + high);
  return low + high;
}

std::vector<double> blurIrradiance(const BlurCase& c, std::size_t bins) {
  const double plateau = 1.0 - fresnelReflectance(1.0, 1.0, c.ior);
  std::vector<double> irradiance;
  for (std::size_t i = 0; i < bins; ++i)
    irradiance.push_back(plateau * edgeSpread(3.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(bins) - 1.5));
  return irradiance;
}

SceneData makeBlurScene(const BlurCase& c) {
  SceneData scene;
  // Wide enough that the other edge's blur ends before the view does: 1.5 ρ + ρ.
  const double half_x = 1.3 * blurRadius(c), half_z = 0.5 * c.length;
  Material water = makeDiffuse("water", vec3(1.0F));
  water.roughness = 0.0F;
  water.specular_factor = 1.0F;
  water.transmission = 1.0F;
  water.thickness = 1.0F;
  water.ior = static_cast<float>(c.ior);
  addObject(scene, makeRectangle("water", {half_x, c.distance, 0}, {half_x, 0, 0}, {0, 0, -half_z}), water);
  addObject(scene, makeRectangle("floor", {0, 0, 0}, {2.0 * c.length, 0, 0}, {0, 0, -2.0 * c.length}),
            makeDiffuse("floor", vec3(0.5F)));
  scene.lights.push_back(makeSun({0, -1, 0}, static_cast<float>(c.angle_deg)));
  return scene;
}

PlaneView blurView(const BlurCase& c) {
  PlaneView view;
  view.distance = 0.5 * c.distance;
  view.width = 3.0 * blurRadius(c);
  view.columns = 512;
  view.rows = static_cast<int>((c.length - 2.1 * blurRadius(c)) / view.pixelSize());
  return view;
}

std::optional<double> measureEdgeWidth(const BlurCase& c, const PlanePicture& picture) {
  constexpr std::size_t kBin = 8;
  const std::vector<double> columns = picture.columnMeans();
  std::vector<double> edge(columns.size() / kBin, 0.0);
  for (std::size_t i = 0; i < edge.size() * kBin; ++i) edge[i / kBin] += columns[i] / double{kBin};
  const double plateau = 1.0 - fresnelReflectance(1.0, 1.0, c.ior);
  const std::optional<double> low = findCrossing(edge, 0.1 * plateau), high = findCrossing(edge, 0.9 * plateau);
  if (!low || !high) return std::nullopt;
  return (*high - *low) * double{kBin} * picture.view.pixelSize() / blurRadius(c);
}

}  // namespace nephroid::closed_form
