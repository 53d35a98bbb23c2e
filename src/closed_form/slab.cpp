#include "closed_form/slab.h"

#include <fmt/format.h>

#include <cmath>

#include "closed_form/optics.h"
#include "scene/load.h"

namespace nephroid::closed_form {

dvec3 slabIrradiance(const SlabCase& c) {
  const double cos_i = std::cos(radiansD(c.angle_deg)), sin_t = std::sin(radiansD(c.angle_deg)) / c.ior;
  const double r = fresnelReflectance(cos_i, 1.0, c.ior);
  const dvec3 kept = glm::pow(c.color, dvec3(1.0 / std::sqrt(1.0 - sin_t * sin_t)));
  return cos_i * (1.0 - r) * (1.0 - r) * kept / (1.0 - r * r * kept * kept);
}

SceneData makeSlabScene(const SlabCase& c) {
  // The slab's centre is at `height`; the sun stands over +X.
  return loadScene(fmt::format(
      "builtin:slab?irradiance=1&sun-azimuth=90&sun-elevation={}&size={}&thickness={}&height={}&"
      "ior={}&color={},{},{}&attenuation-distance={}&floor-size=4",
      90.0 - c.angle_deg, c.size, c.thickness, c.height, c.ior, c.color.x, c.color.y, c.color.z, c.thickness));
}

PlaneView slabView(const SlabCase& c) {
  const double below = c.height - 0.5 * c.thickness,
               tan_t = std::tan(std::asin(std::sin(radiansD(c.angle_deg)) / c.ior));
  const double shift = below * std::tan(radiansD(c.angle_deg)) + 0.5 * c.thickness * tan_t;
  PlaneView view;
  view.centre = vec3(-static_cast<float>(shift), 0, 0);
  view.distance = 0.5 * below;
  view.width = 0.5 * c.size;
  view.columns = view.rows = 16;
  return view;
}

dvec3 meanIrradiance(const PlanePicture& picture) {
  return picture.flux() / (picture.view.width * picture.view.height());
}

}  // namespace nephroid::closed_form
