#include "closed_form/drop.h"

#include <algorithm>
#include <cmath>

#include "closed_form/optics.h"
#include "core/spectrum.h"
#include "scene/builtin/shapes.h"

namespace nephroid::closed_form {

double bowAngle(const DropCase& c, double ior) {
  const double incidence = std::acos(std::sqrt((ior * ior - 1.0) / 3.0));
  const double inside = std::asin(std::sin(incidence) / ior);
  return 4.0 * inside - 2.0 * incidence + std::asin(std::sin(incidence) / c.distance);
}

PlaneView dropView(const DropCase& c) {
  const double angle = radiansD(c.angle_deg);
  PlaneView view;
  view.centre = vec3(dvec3(std::sin(angle), std::cos(angle), 0.0) * c.distance);
  view.normal = -normalize(view.centre);
  view.up = vec3(dvec3(std::cos(angle), -std::sin(angle), 0.0));
  view.distance = 0.5 * c.distance;
  view.columns = 1300;
  view.rows = 314;
  view.width = 2.0 * std::tan(radiansD(c.half_angle_deg)) * c.distance * view.columns / view.rows;
  return view;
}

SceneData makeDropScene(const DropCase& c) {
  SceneData scene;
  scene.name = "drop";
  Material water;
  water.name = "water";
  water.roughness = 0.0F;
  water.transmission = water.thickness = 1.0F;
  water.ior = static_cast<float>(c.ior);
  water.dispersion = static_cast<float>(20.0 / c.abbe);
  Material white;
  white.base_color = vec4(1.0F);
  scene.materials = {water, white};
  scene.meshes = {makeSphere("drop", dvec3(0.0), 1.0, 384)};
  const PlaneView view = dropView(c);
  const dvec3 right = dvec3(cross(view.up, view.normal)) * (0.5 * view.width);
  scene.meshes.push_back(makeRectangle("screen", dvec3(view.centre), dvec3(view.up) * (0.5 * view.height()), -right));
  scene.meshes[0].material = 0, scene.meshes[1].material = 1;
  for (std::uint32_t i = 0; i < 2; ++i) {
    Instance instance;
    instance.name = scene.meshes[i].name;
    instance.mesh = instance.object = i;
    scene.instances.push_back(instance);
  }
  scene.lights = {makeSun(vec3(0, -1, 0))};
  return scene;
}

std::vector<dvec3> angularProfile(const PlanePicture& picture, double lower, double upper, std::size_t bins) {
  const PlaneView& view = picture.view;
  const dvec3 right(cross(view.up, view.normal));
  std::vector<dvec3> profile(bins, dvec3(0.0));
  for (int y = 0; y < picture.irradiance.height; ++y) {
    for (int x = 0; x < picture.irradiance.width; ++x) {
      const double along = (x + 0.5 - 0.5 * view.columns) * view.pixelSize();
      const double across = (0.5 * view.rows - y - 0.5) * view.pixelSize();
      const dvec3 place = dvec3(view.centre) + along * right + across * dvec3(view.up);
      const double bin =
          (std::acos(place.y / glm::length(place)) - lower) / (upper - lower) * static_cast<double>(bins);
      if (bin >= 0.0 && bin < static_cast<double>(bins))
        profile[static_cast<std::size_t>(bin)] += dvec3(picture.irradiance.rgb(x, y));
    }
  }
  return profile;
}

std::vector<double> bowErrors_deg(const DropCase& c, const PlanePicture& picture) {
  constexpr double kBin_deg = 0.02, kLower_deg = 40.0, kUpper_deg = 44.0;
  const std::vector<Band> bands = makeBands(kBowBands);
  const auto bins = static_cast<std::size_t>(std::lround((kUpper_deg - kLower_deg) / kBin_deg));
  const std::vector<dvec3> profile = angularProfile(picture, radiansD(kLower_deg), radiansD(kUpper_deg), bins);
  const glm::dmat3 bands_from_rgb =
      glm::inverse(glm::dmat3(dvec3(bands[0].weight), dvec3(bands[1].weight), dvec3(bands[2].weight)));
  std::vector<double> errors;
  for (int b = 0; b < kBowBands; ++b) {
    std::vector<double> flux;
    for (const dvec3& rgb : profile) flux.push_back((bands_from_rgb * rgb)[b]);
    const double densest = *std::max_element(flux.begin(), flux.end());
    // Light that the drop's front mirrors comes to all angles, thinly.
    std::size_t edge = bins;
    while (edge > 0 && flux[edge - 1] < 0.3 * densest) --edge;
    const double ior =
        cauchyIndex(c.ior, c.abbe, static_cast<double>(bands[static_cast<std::size_t>(b)].wavelength_nm));
    errors.push_back(std::abs(kLower_deg + kBin_deg * static_cast<double>(edge) - degreesD(bowAngle(c, ior))));
  }
  return errors;
}

}  // namespace nephroid::closed_form
