#include "frame/lamps.h"

#include <cmath>

namespace nephroid {

std::vector<LampRecord> makeLamps(const SceneData& scene) {
  std::vector<LampRecord> lamps;
  for (const Light& light : scene.lights) {
    if (!(luminance(light.intensity) > 0.0F)) continue;
    LampRecord lamp{};
    lamp.direction = light.direction;
    if (light.kind == LightKind::kSun) {
      if (!(light.angle_deg > 0.0F)) continue;
      // E⊥/(π sin²) over the disc, whose 1 − cos is 2 sin² of a quarter of the angle.
      const double sin_half = std::sin(0.5 * radians(light.angle_deg));
      const double sin_quarter = std::sin(0.25 * radians(light.angle_deg));
      lamp.radiance = light.intensity * static_cast<float>(1.0 / (kPi * sin_half * sin_half));
      lamp.one_minus_cos = static_cast<float>(2.0 * sin_quarter * sin_quarter);
    } else {
      if (!(light.radius > 0.0F)) continue;
      lamp.position = light.position;
      lamp.radius = light.radius;
      lamp.radiance = light.intensity / (kPi * light.radius * light.radius);
      lamp.cos_outer = std::cos(light.outer_cone);
      lamp.cos_inner = std::cos(light.inner_cone);
      lamp.is_spot = light.kind == LightKind::kSpot ? 1 : 0;
    }
    lamps.push_back(lamp);
  }
  return lamps;
}

}  // namespace nephroid
