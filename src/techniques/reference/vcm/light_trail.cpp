#include "techniques/reference/vcm/light_trail.h"

namespace nephroid {

void VcmTrail::arrive(const SurfacePoint& point, vec3 dir, bool connects) {
  const vec3 way = point.position - previous_;
  const float squared = dot(way, way), cos_in = std::abs(dot(dir, point.normal_geometric));
  if (events_ > 0) {
    arrived_ = half_.arrive(squared, cos_in);
    return;
  }
  const LightSet& lights = techniques_->world().lights;
  const LightRay ray{point.position, dir, std::sqrt(squared), light_normal_};
  // Only a rough interface can find the light.
  const float direct = connects ? lights.densityTowards(source_, ray) : 0.0F;
  arrived_ =
      VcmPartial::startAtLight(direct, techniques_->arrivalDensity(source_, ray), cos_in, !lights.isDelta(source_));
}

void VcmTrail::scatter(const VcmSurface& surface, vec3 wo, const BsdfSample& sample, float probability) {
  if (sample.pass) return;
  const float cos_out = surface.cosine(sample.dir);
  if (sample.delta) {
    half_ = arrived_.scatterDelta(cos_out);
  } else {
    const float reverse = surface.density(EventClass::kSpecular, sample.dir, wo);
    half_ = arrived_.scatter(cos_out, probability * sample.pdf, reverse, 0.0F);
  }
  previous_ = surface.point().position;
  ++events_;
}

float VcmTrail::weighSeenAt(const VcmSurface& surface, vec3 wo, vec3 to_camera, float importance) const {
  const float reverse = arrived_.dvc > 0.0F ? surface.density(EventClass::kDiffuse, to_camera, wo) : 0.0F;
  return weighSeen(techniques_->photons(), importance, surface.cosine(to_camera),
                   arrived_.sumBehind(reverse, techniques_->merging()));
}

}  // namespace nephroid
