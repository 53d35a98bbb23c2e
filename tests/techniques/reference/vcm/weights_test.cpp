// The recursion against what it stands for: densities of whole paths by every technique, multiplied out.
#include "techniques/reference/vcm/weights.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace nephroid {
namespace {

/// L S⁺ D S* E with random densities. Vertices from the light: 0 is on it, 1 … receiver − 1 are S, then D, then S up to
/// the last, which the camera sees.
struct RandomPath {
  RandomPath(unsigned seed, std::size_t light_side, std::size_t eye_side)
      : count(light_side + eye_side + 2), receiver(light_side + 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.2, 2.0);
    for (std::size_t i = 0; i < count; ++i) {
      delta.push_back(i != 0 && i != receiver && random() % 2 == 0);
      pdf_onward.push_back(uniform(random)), pdf_back.push_back(uniform(random));
      cos_to_light.push_back(0.4 * uniform(random)), cos_to_eye.push_back(0.4 * uniform(random));
      squared.push_back(uniform(random));
      // A mirror does the same both ways.
      if (delta.back()) pdf_back.back() = pdf_onward.back();
    }
    direct = uniform(random), arrival = uniform(random), importance = uniform(random);
  }

  /// Density per area of vertex i made from the light (of vertices 0 and 1 together for i = 1), or from the eye.
  double fromLight(std::size_t i) const {
    return i == 1 ? arrival * cos_to_light[1] : pdf_onward[i - 1] * cos_to_light[i] / squared[i - 1];
  }
  double fromEye(std::size_t i) const {
    return i + 1 == count ? importance * cos_to_eye[i] : pdf_back[i + 1] * cos_to_eye[i] / squared[i];
  }
  /// Of vertices [i, count) from the eye; vertex 0 is met by solid angle.
  double fromEyeDownTo(std::size_t i) const {
    double product = 1.0;
    for (std::size_t k = std::max<std::size_t>(i, 1); k < count; ++k) product *= fromEye(k);
    return i == 0 ? product * pdf_back[1] : product;
  }
  /// Of vertices [0, i]; the light's alone is chosen as vertex 1 would choose it.
  double fromLightUpTo(std::size_t i) const {
    if (i == 0) return direct;
    double product = 1.0;
    for (std::size_t k = 1; k <= i; ++k) product *= fromLight(k);
    return product;
  }

  /// Densities by all techniques that are used: met, found, connections behind vertices 1 …, seen, merged.
  std::vector<double> densities() const {
    std::vector<double> all{has_size ? fromEyeDownTo(0) : 0.0};
    for (std::size_t end = 0; end <= receiver; ++end) {
      if (end + 1 == count)
        all.push_back(fromLightUpTo(end) * photons);
      else
        all.push_back(delta[end] || delta[end + 1] ? 0.0 : fromLightUpTo(end) * fromEyeDownTo(end + 1));
    }
    all.push_back(fromLightUpTo(receiver) * fromEyeDownTo(receiver) * merging);
    return all;
  }

  VcmPartial lightHalfAt(std::size_t end) const {
    VcmPartial half = VcmPartial::startAtLight(delta[1] ? 0.0F : f(direct), f(arrival), f(cos_to_light[1]), has_size);
    for (std::size_t i = 1; i < end; ++i) {
      half = delta[i] ? half.scatterDelta(f(cos_to_eye[i]))
                      : half.scatter(f(cos_to_eye[i]), f(pdf_onward[i]), f(pdf_back[i]), 0.0F);
      half = half.arrive(f(squared[i]), f(cos_to_light[i + 1]));
    }
    return half;
  }
  VcmPartial eyeHalfAt(std::size_t end, bool leave = false) const {
    VcmPartial half = VcmPartial::startAtEye(f(photons), f(importance), f(cos_to_eye[count - 1]));
    for (std::size_t i = count - 1; i > end || (leave && i == end); --i) {
      half = delta[i] ? half.scatterDelta(f(cos_to_light[i]))
                      : half.scatter(f(cos_to_light[i]), f(pdf_back[i]), i > receiver ? 0.0F : f(pdf_onward[i]),
                                     i == receiver ? f(merging) : 0.0F);
      if (i > receiver) half = half.forgetLightEnd();
      if (i > end) half = half.arrive(f(squared[i - 1]), f(cos_to_eye[i - 1]));
    }
    return half;
  }
  float behindLight(std::size_t i) const {
    return lightHalfAt(i).sumBehind(f(pdf_back[i]), i == receiver ? f(merging) : 0.0F);
  }
  float behindEye(std::size_t i) const {
    if (i > receiver) return 0.0F;
    return eyeHalfAt(i).sumBehind(i == receiver ? 0.0F : f(pdf_onward[i]), i == receiver ? f(merging) : 0.0F);
  }

  /// Their weights by the recursion, in the same order; 0 where the technique is not to be had.
  std::vector<double> weights() const {
    std::vector<double> all{has_size ? weighMet(eyeHalfAt(1, true), f(direct), f(arrival)) : 0.0};
    all.push_back(delta[1] ? 0.0
                           : weighFound(f(direct), has_size ? f(pdf_back[1]) : 0.0F, f(arrival), f(cos_to_light[1]),
                                        behindEye(1)));
    for (std::size_t end = 1; end <= receiver; ++end) {
      if (end + 1 == count)
        all.push_back(weighSeen(f(photons), f(importance), f(cos_to_eye[end]), behindLight(end)));
      else if (delta[end] || delta[end + 1])
        all.push_back(0.0);
      else
        all.push_back(weighConnection(f(fromEye(end)), behindLight(end), f(fromLight(end + 1)), behindEye(end + 1)));
    }
    all.push_back(weighMerge(lightHalfAt(receiver), eyeHalfAt(receiver), f(pdf_back[receiver]), f(merging)));
    return all;
  }

  static float f(double x) { return static_cast<float>(x); }

  std::size_t count, receiver;
  bool has_size = true;
  std::vector<bool> delta;
  std::vector<double> pdf_onward, pdf_back;      ///< per solid angle, of the way on to the eye, and to the light
  std::vector<double> cos_to_light, cos_to_eye;  ///< at the vertex
  std::vector<double> squared;                   ///< distance from vertex i to i + 1
  double direct = 1, arrival = 1, importance = 1;
  double photons = 7.0, merging = 0.3;
};

class VcmWeights : public testing::TestWithParam<bool> {};

TEST_P(VcmWeights, AreTheBalanceHeuristicAndSumToOne) {
  for (unsigned seed = 0; seed < 400; ++seed) {
    RandomPath path(seed, 1 + seed % 4, seed / 4 % 3);
    path.has_size = GetParam();
    const std::vector<double> densities = path.densities(), weights = path.weights();
    ASSERT_EQ(densities.size(), weights.size());
    double total = 0.0, sum = 0.0;
    for (const double density : densities) total += density;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      EXPECT_NEAR(weights[i], densities[i] / total, 2e-5) << "seed " << seed << " technique " << i;
      sum += weights[i];
    }
    EXPECT_NEAR(sum, 1.0, 5e-5) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(LightsWithASize, VcmWeights, testing::Bool());

TEST(VcmWeights, OfAnOnlyTechniqueIsOne) {
  // A point light through clear glass, seen through clear glass: merging is all there is.
  RandomPath path(1, 2, 1);
  path.has_size = false;
  path.delta = {false, true, true, false, true};
  const std::vector<double> weights = path.weights();
  EXPECT_EQ(weights.back(), 1.0);
  for (std::size_t i = 0; i + 1 < weights.size(); ++i) EXPECT_EQ(weights[i], 0.0) << i;
}

}  // namespace
}  // namespace nephroid
