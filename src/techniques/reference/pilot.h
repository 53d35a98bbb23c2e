// Small pictures by which a render chooses how to go about itself.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "techniques/reference/film.h"
#include "techniques/reference/path_tracer.h"
#include "techniques/reference/world.h"

namespace nephroid {

/// Each is a place where the light may be another.
inline constexpr double kPilotPixels = 384.0;

/// The world as a small picture of a few hundred pixels sees it, with other random numbers, while this lives.
class PilotView {
 public:
  /// @param width,height  of the picture that is meant  @param pixels  of the small one, about
  PilotView(ReferenceWorld& world, const Camera& camera, int width, int height, double pixels = kPilotPixels);
  ~PilotView();
  PilotView(const PilotView&) = delete;
  PilotView& operator=(const PilotView&) = delete;

 private:
  ReferenceWorld& world_;
  CameraModel camera_;
  std::uint32_t seed_;
};

/// One pass of paths. @param parts  by pixel, or nothing: what they bring and cost is added to it  @return rays
double tracePilotPass(const PathTracer& tracer, std::uint32_t pass, Film& film, std::span<PartTally> parts = {});

/// The picture of each pass, summed, and how passes differ.
class PilotSpread {
 public:
  explicit PilotSpread(std::size_t pixels) : sums_(pixels, dvec3(0.0)), squares_(sums_) {}

  /// @param sum_at  of a pixel: radiance summed over all passes so far
  template <class SumAt>
  void close(const SumAt& sum_at) {
    for (std::size_t pixel = 0; pixel < sums_.size(); ++pixel) {
      const dvec3 sum = sum_at(pixel), gained = sum - sums_[pixel];
      sums_[pixel] = sum;
      squares_[pixel] += gained * gained;
      const double brightness = std::max({gained.x, gained.y, gained.z});
      light_ += brightness, light_squared_ += brightness * brightness;
    }
    ++passes_;
  }

  double contributions() const { return light_squared_ > 0.0 ? light_ * light_ / light_squared_ : 0.0; }
  dvec3 meanAt(std::size_t pixel) const { return sums_[pixel] / passes_; }
  std::size_t pixels() const { return sums_.size(); }
  double total() const {
    double total = 0.0;
    for (std::size_t pixel = 0; pixel < sums_.size(); ++pixel) total += luminance(vec3(meanAt(pixel)));
    return total;
  }
  dvec3 varianceOfMeanAt(std::size_t pixel) const {
    const dvec3 mean = meanAt(pixel);
    return glm::max(squares_[pixel] / passes_ - mean * mean, dvec3(0.0)) / (passes_ - 1.0);
  }

 private:
  std::vector<dvec3> sums_, squares_;  ///< by pixel
  double passes_ = 0.0, light_ = 0.0, light_squared_ = 0.0;
};

/// Means over 5 × 5 pixels: few passes know the light of a pixel badly, and an estimate that is divided by itself hides
/// how rare the paths are that found it.
std::vector<dvec3> blurPilot(const std::vector<dvec3>& picture, int width, int height);

/// What keeps dark pixels from ruling a relative error, as in metrics (DESIGN, "Error figures"): a share of the mean.
double pilotFloor(const std::vector<dvec3>& picture);

}  // namespace nephroid
