#include "techniques/reference/direction_guide.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/sampling/warp.h"

namespace nephroid {
namespace {

/// Of a cell at least; twice as many are two cells.
constexpr std::size_t kLessonsOfCell = 8192;
/// Points that a ball is divided by, if its mass is so large a share of what one ball around everything would have.
constexpr std::size_t kFewestOfBall = 16;
constexpr double kLeastShare = 1.0 / 256.0;
/// Radius over that of the points met: few points do not reach the edge of what they were drawn from.
constexpr float kMargin = 1.2F;
/// Rays of a path before it goes on, roughly: a way that meets nothing is not free.
constexpr double kRaysBefore = 1.0;
/// Sine of the angle that a ball's radius is seen under at least: light that few lessons met comes from beside those
/// points as well.
constexpr float kLeastSine = 0.01F;
/// Where nothing was met: at so many times the largest distance at which something was.
constexpr float kInfinity = 1000.0F;
/// A lobe whose lessons gained less is not worth looking up.
constexpr double kLeastGain = 1.5;

/// Where the lesson met something. @pre a finite distance
vec3 metBy(const DirectionLesson& lesson) { return lesson.position + lesson.distance * lesson.dir; }

/// Makes every distance finite.
void bringInfinityNear(std::span<DirectionLesson> lessons) {
  float farthest = 0.0F;
  for (const DirectionLesson& lesson : lessons)
    if (std::isfinite(lesson.distance)) farthest = std::max(farthest, lesson.distance);
  const float infinity = farthest > 0.0F ? kInfinity * farthest : 1.0F;
  for (DirectionLesson& lesson : lessons)
    if (!std::isfinite(lesson.distance)) lesson.distance = infinity;
}

/// 1 − cos of the half-angle of a ball. @param offset  to its centre  @return 2 from inside
float oneMinusCosOf(vec3 offset, float squared_radius) {
  const float squared_distance = dot(offset, offset);
  if (squared_distance <= squared_radius) return 2.0F;
  const float sin2 = squared_radius / squared_distance;
  return sin2 / (1.0F + std::sqrt(1.0F - sin2));
}

int longestAxis(vec3 size) { return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2; }

/// Points that lessons met, and what came from there.
class Cluster {
 public:
  explicit Cluster(std::span<const DirectionLesson> lessons) {
    double rays = 0.0;
    for (const DirectionLesson& lesson : lessons) {
      const vec3 point = metBy(lesson);
      low_ = glm::min(low_, point), high_ = glm::max(high_, point);
      squares_ += static_cast<double>(lesson.value) * lesson.value / lesson.pdf;
      rays += kRaysBefore + lesson.rays;
    }
    rays_ = rays / static_cast<double>(lessons.size());
    for (const DirectionLesson& lesson : lessons) {
      const vec3 offset = metBy(lesson) - centre();
      squared_radius_ = std::max(squared_radius_, kMargin * kMargin * dot(offset, offset));
    }
  }
  vec3 centre() const { return 0.5F * (low_ + high_); }
  int axis() const { return longestAxis(high_ - low_); }
  float squaredRadius() const { return squared_radius_; }
  /// √(∫ square × solid angle / rays): in proportion to the probability that suits it.
  double mass(double solid_angle) const { return std::sqrt(squares_ * solid_angle / rays_); }

 private:
  vec3 low_{std::numeric_limits<float>::max()}, high_{std::numeric_limits<float>::lowest()};
  double squares_ = 0.0;  ///< Σ value²/pdf, an estimate of ∫ value² dω over all lessons of the cell
  double rays_ = 0.0;     ///< of one way
  float squared_radius_ = 0.0F;
};

double gainOf(std::span<const DirectionLesson> lessons) {
  double by_both = 0.0, by_bsdf = 0.0, rays_of_both = 0.0, rays_of_bsdf = 0.0;
  for (const DirectionLesson& lesson : lessons) {
    const double rarity = static_cast<double>(lesson.pdf_bsdf) / lesson.pdf, way = lesson.value / lesson.pdf;
    by_both += way * way;
    if (rarity > 0.0) by_bsdf += way * way / rarity;
    rays_of_both += kRaysBefore + lesson.rays;
    rays_of_bsdf += rarity * (kRaysBefore + lesson.rays);
  }
  return by_both > 0.0 ? by_bsdf * rays_of_bsdf / (by_both * rays_of_both) : 1.0;
}

}  // namespace

DirectionLobe::DirectionLobe(std::span<DirectionLesson> lessons) : gain_(gainOf(lessons)) {
  vec3 from(0.0F);
  for (const DirectionLesson& lesson : lessons) from += lesson.position / static_cast<float>(lessons.size());
  const auto dark =
      std::partition(lessons.begin(), lessons.end(), [](const DirectionLesson& lesson) { return lesson.value > 0.0F; });
  const std::span<DirectionLesson> bright(lessons.begin(), dark);
  if (bright.empty()) return;
  bringInfinityNear(bright);
  divide(bright, from, kLeastShare * Cluster(bright).mass(4.0 * kPi));
  double sum = 0.0, until = 0.0;
  for (const Target& target : targets_) sum += target.share;
  for (Target& target : targets_) {
    target.share = static_cast<float>(target.share / sum);
    until += target.share;
    target.until = static_cast<float>(until);
  }
  targets_.back().until = 1.0F;
}

/// @param from  where they are seen from  @param least  mass of what is divided
void DirectionLobe::divide(std::span<DirectionLesson> lessons, vec3 from, double least) {
  const Cluster cluster(lessons);
  const vec3 offset = cluster.centre() - from;
  const float squared_radius = std::max(cluster.squaredRadius(), kLeastSine * kLeastSine * dot(offset, offset));
  const float one_minus_cos = oneMinusCosOf(offset, squared_radius);
  const double mass = cluster.mass(2.0 * kPi * one_minus_cos);
  if (lessons.size() < kFewestOfBall || mass <= least) {
    targets_.push_back({cluster.centre(), squared_radius, static_cast<float>(mass), 0.0F});
    return;
  }
  const int axis = cluster.axis();
  const auto middle = lessons.begin() + static_cast<std::ptrdiff_t>(lessons.size() / 2);
  std::nth_element(lessons.begin(), middle, lessons.end(),
                   [&](const DirectionLesson& a, const DirectionLesson& b) { return metBy(a)[axis] < metBy(b)[axis]; });
  divide({lessons.begin(), middle}, from, least);
  divide({middle, lessons.end()}, from, least);
}

vec3 DirectionLobe::sample(vec3 position, vec2 u) const {
  const auto target =
      std::upper_bound(targets_.begin(), targets_.end() - 1, u.x, [](float x, const Target& t) { return x < t.until; });
  u.x = std::clamp((u.x - (target->until - target->share)) / target->share, 0.0F, kOneMinusEpsilon);
  const vec3 offset = target->centre - position;
  const float one_minus_cos = oneMinusCosOf(offset, target->squared_radius);
  if (one_minus_cos >= 2.0F) return sampleUniformSphere(u);
  return Frame::fromZ(normalize(offset)).toWorld(sampleUniformCone(u, one_minus_cos));
}

float DirectionLobe::pdf(vec3 position, vec3 dir) const {
  float density = 0.0F;
  for (const Target& target : targets_) {
    const vec3 offset = target.centre - position;
    const float squared_distance = dot(offset, offset), along = dot(offset, dir);
    // Within the cone: cos² of the angle to the centre is at least 1 − (radius / distance)².
    const bool inside = squared_distance <= target.squared_radius;
    if (inside || (along > 0.0F && along * along >= squared_distance - target.squared_radius))
      density += target.share * pdfSolidAngleUniformCone(oneMinusCosOf(offset, target.squared_radius));
  }
  return density;
}

DirectionGuide::DirectionGuide(std::vector<DirectionLesson> lessons) {
  if (!lessons.empty()) divide(lessons);
  forgotten_.resize(lobes_.size(), 0);
}

void DirectionGuide::divide(std::span<DirectionLesson> lessons) {
  const std::size_t index = cells_.size();
  cells_.emplace_back();
  if (lessons.size() < 2 * kLessonsOfCell) {
    cells_[index].index = static_cast<std::uint32_t>(lobes_.size());
    lobes_.emplace_back(lessons);
    return;
  }
  vec3 low = lessons.front().position, high = low;
  for (const DirectionLesson& lesson : lessons)
    low = glm::min(low, lesson.position), high = glm::max(high, lesson.position);
  const int axis = longestAxis(high - low);
  const auto middle = lessons.begin() + static_cast<std::ptrdiff_t>(lessons.size() / 2);
  std::nth_element(lessons.begin(), middle, lessons.end(), [&](const DirectionLesson& a, const DirectionLesson& b) {
    return a.position[axis] < b.position[axis];
  });
  cells_[index].axis = axis;
  cells_[index].at = middle->position[axis];
  divide({lessons.begin(), middle});
  cells_[index].index = static_cast<std::uint32_t>(cells_.size());
  divide({middle, lessons.end()});
}

const DirectionLobe* DirectionGuide::at(vec3 position) const {
  if (cells_.empty()) return nullptr;
  std::size_t index = 0;
  while (cells_[index].axis >= 0) {
    const Cell& cell = cells_[index];
    index = position[cell.axis] < cell.at ? index + 1 : cell.index;
  }
  const std::uint32_t lobe = cells_[index].index;
  return forgotten_[lobe] != 0 || lobes_[lobe].empty() ? nullptr : &lobes_[lobe];
}

void DirectionGuide::keepWhatPays() {
  for (std::size_t lobe = 0; lobe < lobes_.size(); ++lobe) forgotten_[lobe] = lobes_[lobe].gain() < kLeastGain ? 1 : 0;
}

}  // namespace nephroid
