// Inputs that twins share: directions, cosines and numbers with their ends and the places where formulas turn.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/glm.hpp>

namespace nephroid::testing {

/// The number next to x on the side of `to`.
inline float nextTo(float x, float to) { return std::nextafter(x, to); }

/// Cosines from grazing to normal incidence, and values outside [0, 1] that functions clamp.
inline std::vector<float> cosines(std::size_t steps) {
  std::vector<float> result{-0.5F, 0.0F, 1e-7F, 1e-4F, nextTo(1.0F, 0.0F), 1.0F, nextTo(1.0F, 2.0F)};
  for (std::size_t i = 1; i < steps; ++i) result.push_back(static_cast<float>(i) / static_cast<float>(steps));
  return result;
}

/// Points of a spiral over the whole sphere, after the axes, the diagonals and directions that almost lie in a plane of
/// two axes.
inline std::vector<glm::vec3> directions(std::size_t on_spiral) {
  std::vector<glm::vec3> result{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const float third = std::sqrt(1.0F / 3.0F), half = std::sqrt(0.5F);
  for (const float x : {-third, third})
    for (const float y : {-third, third})
      for (const float z : {-third, third}) result.emplace_back(x, y, z);
  for (const glm::vec3& v : {glm::vec3(half, half, 0), glm::vec3(0, half, -half), glm::vec3(-half, 0, half)})
    result.push_back(v);
  for (const float tiny : {1e-3F, 1e-7F, -1e-7F}) {
    result.push_back(glm::normalize(glm::vec3(0.6F, 0.8F, tiny)));
    result.push_back(glm::normalize(glm::vec3(tiny, tiny, 1.0F)));
  }
  for (std::size_t i = 0; i < on_spiral; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(on_spiral);
    const double turn = 2.399963229728653 * static_cast<double>(i);  // the golden angle: no two points line up
    const double r = std::sqrt(1.0 - z * z);
    result.emplace_back(static_cast<float>(r * std::cos(turn)), static_cast<float>(r * std::sin(turn)),
                        static_cast<float>(z));
  }
  return result;
}

}  // namespace nephroid::testing
