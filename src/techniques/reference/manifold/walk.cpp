#include "techniques/reference/manifold/walk.h"

namespace nephroid {
namespace {

/// Steps before a walk is given up. From a good seed it takes four or five; more than this wander along a fold.
constexpr int kMaxSteps = 24;
/// A step is halved to this share at least.
constexpr float kLeastStep = 1.0F / 64.0F;
/// Residual of a solution, at most: a sine. A step may be short because derivatives are steep, not because it is there.
constexpr float kLargestResidual = 1e-3F;

/// What changes the residual to zero, were it linear; nothing on a fold.
std::optional<vec2> newtonStep(const ChainConstraint& c) {
  const float determinant = c.by_x.x * c.by_y.y - c.by_x.y * c.by_y.x;
  if (determinant == 0.0F) return std::nullopt;
  const vec2 r = c.residual;
  return vec2(r.y * c.by_y.x - r.x * c.by_y.y, r.x * c.by_x.y - r.y * c.by_x.x) / determinant;
}

}  // namespace

bool ManifoldWalk::retrace(SpecularChain& chain, vec3 dir, const ChainKind& kind, Sampler& sampler,
                           std::uint64_t& rays) const {
  if (!chain.start(dir)) return false;
  for (int i = 0; i < kind.count; ++i) {
    if (i > 0 && !chain.bend(kind.bounces[i - 1])) return false;
    if (!chain.advance(sampler, rays)) return false;
  }
  return true;
}

bool ManifoldWalk::solve(const ChainKind& kind, const ChainEnd& end, float scale, Sampler& sampler,
                         std::uint64_t& rays) {
  ChainConstraint here = chain().constrain(kind.last(), end.light, end.at_infinity);
  float share = 1.0F;
  for (int step = 0; step < kMaxSteps; ++step) {
    const std::optional<vec2> change = newtonStep(here);
    if (!change || !std::isfinite(change->x) || !std::isfinite(change->y)) return false;
    const float residual = length(here.residual);
    if (length(chain().firstShift(*change)) <= kPrecision * scale)
      return residual <= kLargestResidual &&
             chain().joinsSides(kind.last(), chain().towardsLight(end.light, end.at_infinity));
    SpecularChain& tried = chains_[1 - current_];
    const Frame& axes = chain().axes();
    for (;; share *= 0.5F) {
      if (share < kLeastStep) return false;
      const vec2 part = share * *change;
      const vec3 dir = normalize(chain().dir() + part.x * axes.x + part.y * axes.y);
      if (!retrace(tried, dir, kind, sampler, rays)) continue;
      const ChainConstraint there = tried.constrain(kind.last(), end.light, end.at_infinity);
      if (!(length(there.residual) < residual)) continue;
      here = there;
      break;
    }
    current_ = 1 - current_;
    share = std::min(2.0F * share, 1.0F);
  }
  return false;
}

}  // namespace nephroid
