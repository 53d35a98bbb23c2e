#include "core/sampling/distribution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/assert.h"

namespace nephroid {
namespace {

float clampBelowOne(double x) { return std::clamp(static_cast<float>(x), 0.0F, kOneMinusEpsilon); }

struct Cell {
  std::size_t index;
  float offset;
};

Cell findCell(float x, std::size_t count) {
  const double scaled = static_cast<double>(x) * static_cast<double>(count);
  const auto index = std::min(static_cast<std::size_t>(std::max(scaled, 0.0)), count - 1);
  return {index, clampBelowOne(scaled - static_cast<double>(index))};
}

std::vector<Distribution1D> makeRows(std::size_t width, std::size_t height, std::span<const float> weights) {
  NEPHROID_ASSERT_EQ(weights.size(), width * height);
  std::vector<Distribution1D> rows;
  rows.reserve(height);
  for (std::size_t y = 0; y < height; ++y) rows.emplace_back(weights.subspan(y * width, width));
  return rows;
}

Distribution1D makeMarginal(const std::vector<Distribution1D>& rows) {
  std::vector<float> totals;
  totals.reserve(rows.size());
  for (const Distribution1D& row : rows) totals.push_back(static_cast<float>(row.total()));
  return Distribution1D(totals);
}

}  // namespace

Distribution1D::Distribution1D(std::span<const float> weights) : cdf_(weights.size() + 1, 0.0) {
  NEPHROID_ASSERT_GE(weights.size(), std::size_t{1});
  for (std::size_t i = 0; i < weights.size(); ++i) {
    NEPHROID_ASSERT_GE(weights[i], 0.0F);
    NEPHROID_ASSERT_LT(weights[i], kInfinity);
    cdf_[i + 1] = cdf_[i] + static_cast<double>(weights[i]);
  }
  total_ = cdf_.back();
  const bool uniform = !(total_ > 0);
  for (std::size_t i = 1; i < cdf_.size(); ++i)
    cdf_[i] = uniform ? static_cast<double>(i) / static_cast<double>(weights.size()) : cdf_[i] / total_;
}

Distribution1D::Sample Distribution1D::sample(float u) const {
  // The last cell that begins at or before u; cells of no width begin where the next one does and are passed over.
  const auto above = std::upper_bound(cdf_.begin(), cdf_.end(), static_cast<double>(std::min(u, kOneMinusEpsilon)));
  const auto index = static_cast<std::size_t>(above - cdf_.begin()) - 1;
  const double width = cdf_[index + 1] - cdf_[index];
  return {index, clampBelowOne((static_cast<double>(u) - cdf_[index]) / width),
          static_cast<float>(width * static_cast<double>(size()))};
}

float Distribution1D::pdf(float x) const {
  const std::size_t index = findCell(x, size()).index;
  return static_cast<float>((cdf_[index + 1] - cdf_[index]) * static_cast<double>(size()));
}

float Distribution1D::invert(std::size_t index, float offset) const {
  return clampBelowOne(cdf_[index] + static_cast<double>(offset) * (cdf_[index + 1] - cdf_[index]));
}

Distribution2D::Distribution2D(std::size_t width, std::size_t height, std::span<const float> weights)
    : rows_(makeRows(width, height, weights)), marginal_(makeMarginal(rows_)) {}

Distribution2D::Sample Distribution2D::sample(vec2 u) const {
  const auto row = marginal_.sample(u.y);
  const auto column = rows_[row.index].sample(u.x);
  const double x = (static_cast<double>(column.index) + column.offset) / static_cast<double>(width());
  const double y = (static_cast<double>(row.index) + row.offset) / static_cast<double>(height());
  return {{clampBelowOne(x), clampBelowOne(y)}, row.pdf * column.pdf};
}

float Distribution2D::pdf(vec2 uv) const {
  return marginal_.pdf(uv.y) * rows_[findCell(uv.y, height()).index].pdf(uv.x);
}

vec2 Distribution2D::invert(vec2 uv) const {
  const Cell row = findCell(uv.y, height());
  const Cell column = findCell(uv.x, width());
  return {rows_[row.index].invert(column.index, column.offset), marginal_.invert(row.index, row.offset)};
}

Distribution2D makeLatLongDistribution(std::size_t width, std::size_t height, std::span<const float> luminance) {
  NEPHROID_ASSERT_EQ(luminance.size(), width * height);
  std::vector<float> weights(luminance.begin(), luminance.end());
  const double rows = static_cast<double>(height);
  for (std::size_t y = 0; y < height; ++y) {
    // cos θ above minus cos θ below, as a product that does not cancel at the poles; ∝ the row's solid angle.
    const double solid_angle = std::sin(std::numbers::pi * (static_cast<double>(y) + 0.5) / rows);
    for (std::size_t x = 0; x < width; ++x) weights[y * width + x] *= static_cast<float>(solid_angle);
  }
  return {width, height, weights};
}

}  // namespace nephroid
