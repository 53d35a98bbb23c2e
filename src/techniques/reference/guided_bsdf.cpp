#include "techniques/reference/guided_bsdf.h"

#include <algorithm>
#include <cmath>

namespace nephroid {
namespace {

/// Share of the ways that the guide draws: what it does not know of then counts twice at most.
constexpr float kGuided = 0.5F;

}  // namespace

std::optional<GuidedBsdf::Way> GuidedBsdf::sample(vec2 u, float u_lobe, WayBy by) const {
  if (!lobe_) {
    const auto s = bsdf_.sample(EventClass::kDiffuse, u, u_lobe, Transport::kRadiance);
    return s ? std::optional<Way>({*s, s->pdf}) : std::nullopt;
  }
  const bool guided = by == WayBy::kGuide || (by == WayBy::kChance && u_lobe < kGuided);
  BsdfSample s;
  if (guided) {
    s.dir = lobe_->sample(position_, u);
  } else {
    if (by == WayBy::kChance) u_lobe = std::min((u_lobe - kGuided) / (1.0F - kGuided), kOneMinusEpsilon);
    const auto drawn = bsdf_.sample(EventClass::kDiffuse, u, u_lobe, Transport::kRadiance);
    if (!drawn) return std::nullopt;
    s = *drawn;
    // The guide cannot draw it.
    if (s.delta) {
      s.weight /= 1.0F - kGuided;
      return Way{s, s.pdf};
    }
  }
  const BsdfValue value = bsdf_.evaluate(EventClass::kDiffuse, s.dir, Transport::kRadiance);
  s.pdf = pdf(s.dir, value.pdf);
  if (maxComponent(value.f) <= 0.0F || s.pdf <= 0.0F) return std::nullopt;
  s.weight = value.f * (std::abs(dot(s.dir, bsdf_.normal())) / s.pdf);
  s.transmitted = bsdf_.transmitsTo(s.dir);
  return Way{s, value.pdf};
}

float GuidedBsdf::pdf(vec3 dir, float by_bsdf) const {
  return lobe_ ? kGuided * lobe_->pdf(position_, dir) + (1.0F - kGuided) * by_bsdf : by_bsdf;
}

}  // namespace nephroid
