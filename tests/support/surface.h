// One surface, to scatter light at.
#pragma once

#include "scene/classify.h"
#include "trace/bsdf.h"

namespace nephroid::test {

/// A surface at the origin, normal +Y, of one material.
struct Surface {
  explicit Surface(const Material& m) : material(m) {
    resolved.source = &material;
    resolved.base = vec3(material.base_color);
    resolved.metallic = material.metallic;
    resolved.alpha = material.roughness * material.roughness;
    if (resolved.alpha < kDeltaAlpha) resolved.alpha = 0.0F;
    resolved.transmission = material.transmission;
    resolved.gloss = glossOf(resolved.alpha, resolved.transmission);
    resolved.is_solid = material.isSolidDielectric();
    resolved.is_pane = material.transmits() && !resolved.is_solid;
    point.normal_geometric = point.normal_shading = vec3(0, 1, 0);
  }
  Bsdf at(vec3 wo, float ior_from = 1.0F, float ior_to = 1.5F) const {
    return Bsdf(resolved, point, wo, ior_from, ior_to, kDefaultSpecularAlpha);
  }
  Material material;
  SurfaceMaterial resolved;
  SurfacePoint point{};
};

}  // namespace nephroid::test
