// LDR-FLIP of Andersson et al., "FLIP: A Difference Evaluator for Alternating Images" [andersson-2020].
//
// Colour: filters of the eye's contrast sensitivity, by opponent channel, take away what is too fine to be seen; then
// the HyAB distance of the colours in CIELAB with Hunt effect, to the power of 0.7, is mapped to [0, 1]. Features:
// edges and points of the luminance, by first and second derivatives of a Gaussian, are compared by strength. Both give
// one error, colour^(1 − feature): a difference of colour is worse where there is a feature in one picture only.
//
// All filters of the paper are products of one across and one down, or sums of two such, and are used as that.

#include "metrics/flip_observer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math.h"
#include "metrics/perceived_colour.h"

namespace nephroid {
namespace {

constexpr double kPiSquared = std::numbers::pi * std::numbers::pi;

/// One term a·exp(−b f²) of a contrast sensitivity, f in cycles per degree (the paper's table of CSF parameters).
struct Sensitivity {
  double a, b;

  /// In space it is a·sqrt(π/b)·exp(−π² x²/b), x in degrees: a Gaussian of this width.
  double sigma(double pixels_per_degree) const { return std::sqrt(b / (2.0 * kPiSquared)) * pixels_per_degree; }
};
constexpr Sensitivity kLuminance{1.0, 0.0047}, kRedGreen{1.0, 0.0053};
constexpr Sensitivity kBlueYellow{13.5, 0.025}, kBlueYellowWide{34.1, 0.04};

/// From peak to trough of the receptive field that finds edges: two standard deviations, in degrees.
constexpr double kFeatureWidth_deg = 0.082;
/// Where filters end: this many standard deviations off the middle, of the widest one.
constexpr double kFilterSigmas = 3.0;

constexpr float kColourExponent = 0.7F;   ///< large distances count less than in proportion
constexpr float kFeatureExponent = 0.5F;  ///< faint features count more than in proportion
/// Distances below this part of the largest one take nearly all of the scale of errors: those beyond are just "large".
constexpr float kKneeOfDistance = 0.4F;
constexpr float kKneeOfError = 0.95F;
/// Luminance as opponent colours have it runs from −16 to 100.
constexpr float kLuminanceRange = 116.0F;

int filterRadius(double sigma) { return static_cast<int>(std::ceil(kFilterSigmas * sigma)); }

/// What the term weighs in a sum, once its Gaussian of `radius` is scaled to sum to 1 both across and down.
double computeWeight(const Sensitivity& term, double pixels_per_degree, int radius) {
  const double sigma = term.sigma(pixels_per_degree);
  double sum = 0.0;
  for (int x = -radius; x <= radius; ++x) sum += std::exp(-x * x / (2.0 * sigma * sigma));
  return term.a * std::sqrt(std::numbers::pi / term.b) * sum * sum;
}

/// The two colours of the cube that are furthest apart are green and blue.
float computeLargestDistance() {
  static const float distance =
      std::pow(hyabDistance(toHuntLab({0.0F, 1.0F, 0.0F}), toHuntLab({0.0F, 0.0F, 1.0F})), kColourExponent);
  return distance;
}

/// @return  in [0, 1]
float computeColourError(vec3 opponent_a, vec3 opponent_b) {
  // Filters may leave the cube of colours: by rounding, and because each channel is smoothed by itself.
  const auto see = [](vec3 opponent) { return toHuntLab(clamp(fromOpponent(opponent), vec3(0.0F), vec3(1.0F))); };
  const float largest = computeLargestDistance();
  const float distance = std::pow(hyabDistance(see(opponent_a), see(opponent_b)), kColourExponent) / largest;
  if (distance < kKneeOfDistance) return kKneeOfError * distance / kKneeOfDistance;
  const float beyond = std::min((distance - kKneeOfDistance) / (1.0F - kKneeOfDistance), 1.0F);
  return kKneeOfError + (1.0F - kKneeOfError) * beyond;
}

/// @return  in [0, 1]
float computeFeatureError(vec2 edge_a, vec2 edge_b, vec2 point_a, vec2 point_b) {
  const auto compare = [](vec2 a, vec2 b) { return std::abs(length(a) - length(b)); };
  const float largest = std::numbers::sqrt2_v<float> * kLuminanceRange;
  const float difference = std::max(compare(edge_a, edge_b), compare(point_a, point_b)) / largest;
  static_assert(kFeatureExponent == 0.5F);
  return std::sqrt(std::min(difference, 1.0F));
}

vec3 colourAt(const OpponentPlanes& planes, int x, int y) {
  return {planes.luminance.row(y)[x], planes.red_green.row(y)[x], planes.blue_yellow.row(y)[x]};
}

/// Adds `scale` times what the product of both kernels makes of `in`.
void addFiltered(const Plane& in, int border, const Kernel& across, const Kernel& down, float scale, Plane& out) {
  Plane filtered(out.width, in.height);
  filterAcross(in, border, across, filtered);
  addFilteredDown(filtered, border, down, scale, out);
}

void clear(Plane& plane) { std::fill(plane.values.begin(), plane.values.end(), 0.0F); }

}  // namespace

FlipObserver::FlipObserver(float pixels_per_degree) {
  const double ppd = pixels_per_degree;
  const int radius = filterRadius(kBlueYellowWide.sigma(ppd));
  luminance_ = makeGaussian(kLuminance.sigma(ppd), radius);
  red_green_ = makeGaussian(kRedGreen.sigma(ppd), radius);
  blue_yellow_ = makeGaussian(kBlueYellow.sigma(ppd), radius);
  blue_yellow_wide_ = makeGaussian(kBlueYellowWide.sigma(ppd), radius);
  const double narrow = computeWeight(kBlueYellow, ppd, radius), wide = computeWeight(kBlueYellowWide, ppd, radius);
  blue_yellow_share_ = static_cast<float>(narrow / (narrow + wide));
  blue_yellow_wide_share_ = static_cast<float>(wide / (narrow + wide));

  const double feature_sigma = 0.5 * kFeatureWidth_deg * ppd;
  const int feature_radius = filterRadius(feature_sigma);
  smooth_ = makeGaussian(feature_sigma, feature_radius);
  slope_ = makeGaussianSlope(feature_sigma, feature_radius);
  curvature_ = makeGaussianCurvature(feature_sigma, feature_radius);
  border_ = std::max(radius, feature_radius);
}

void FlipObserver::look(const OpponentPlanes& shown, Percept& percept) const {
  lookAtColours(shown, percept.colour);
  lookForFeatures(shown.luminance, percept);
}

void FlipObserver::lookAtColours(const OpponentPlanes& shown, OpponentPlanes& seen) const {
  for (Plane* plane : {&seen.luminance, &seen.red_green, &seen.blue_yellow}) clear(*plane);
  addFiltered(shown.luminance, border_, luminance_, luminance_, 1.0F, seen.luminance);
  addFiltered(shown.red_green, border_, red_green_, red_green_, 1.0F, seen.red_green);
  addFiltered(shown.blue_yellow, border_, blue_yellow_, blue_yellow_, blue_yellow_share_, seen.blue_yellow);
  addFiltered(shown.blue_yellow, border_, blue_yellow_wide_, blue_yellow_wide_, blue_yellow_wide_share_,
              seen.blue_yellow);
}

void FlipObserver::lookForFeatures(const Plane& luminance, Percept& percept) const {
  for (Plane* plane : {&percept.edges_x, &percept.edges_y, &percept.points_x, &percept.points_y}) clear(*plane);
  addFiltered(luminance, border_, slope_, smooth_, 1.0F, percept.edges_x);
  addFiltered(luminance, border_, curvature_, smooth_, 1.0F, percept.points_x);
  // What is smoothed across serves both derivatives down.
  Plane smoothed(percept.edges_y.width, luminance.height);
  filterAcross(luminance, border_, smooth_, smoothed);
  addFilteredDown(smoothed, border_, slope_, 1.0F, percept.edges_y);
  addFilteredDown(smoothed, border_, curvature_, 1.0F, percept.points_y);
}

float computeFlip(const Percept& a, const Percept& b, int x, int y) {
  const auto at = [x, y](const Plane& across, const Plane& down) { return vec2(across.row(y)[x], down.row(y)[x]); };
  const float colour = computeColourError(colourAt(a.colour, x, y), colourAt(b.colour, x, y));
  const float feature = computeFeatureError(at(a.edges_x, a.edges_y), at(b.edges_x, b.edges_y),
                                            at(a.points_x, a.points_y), at(b.points_x, b.points_y));
  return std::pow(colour, 1.0F - feature);
}

}  // namespace nephroid
