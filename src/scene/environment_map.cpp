#include "scene/environment_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace nephroid {
namespace {

/// Weight of a texel in the table: luminance spread over its neighbours, so that wherever the bilinear look-up is
/// above zero the density is too, times the solid angle of its row.
std::vector<float> tabulateEnvironment(const Image& image) {
  std::vector<float> weights(static_cast<std::size_t>(image.width) * image.height);
  const auto luminanceAt = [&](int x, int y) {
    x = (x + image.width) % image.width;
    y = std::clamp(y, 0, image.height - 1);
    return std::max(luminance(image.rgb(x, y)), 0.0F);
  };
  static constexpr float kTent[3] = {0.25F, 0.5F, 0.25F};
  for (int y = 0; y < image.height; ++y) {
    const float sin_theta = std::sin(kPi * (static_cast<float>(y) + 0.5F) / static_cast<float>(image.height));
    for (int x = 0; x < image.width; ++x) {
      float sum = 0.0F;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) sum += kTent[dx + 1] * kTent[dy + 1] * luminanceAt(x + dx, y + dy);
      weights[static_cast<std::size_t>(y) * image.width + x] = sum * sin_theta;
    }
  }
  return weights;
}

float meanOverSphere(const Image& image) {
  double sum = 0.0, weight = 0.0;
  for (int y = 0; y < image.height; ++y) {
    const double sin_theta = std::sin(kPi * (y + 0.5) / image.height);
    for (int x = 0; x < image.width; ++x) sum += sin_theta * luminance(image.rgb(x, y));
    weight += sin_theta * image.width;
  }
  return weight > 0.0 ? static_cast<float>(sum / weight) : 0.0F;
}

}  // namespace

EnvironmentMap::EnvironmentMap(const Environment& environment)
    : environment_(environment),
      cos_rotation_(std::cos(radians(environment.rotation_deg))),
      sin_rotation_(std::sin(radians(environment.rotation_deg))),
      distribution_(environment.radiance->width, environment.radiance->height,
                    tabulateEnvironment(*environment.radiance)),
      mean_luminance_(meanOverSphere(*environment.radiance) * environment.scale) {}

vec2 EnvironmentMap::uvFromDir(vec3 dir) const {
  const float x = dir.x * cos_rotation_ - dir.z * sin_rotation_;
  const float z = dir.x * sin_rotation_ + dir.z * cos_rotation_;
  const float u = 0.5F + std::atan2(x, -z) * (0.5F / kPi);
  return {u - std::floor(u), std::acos(std::clamp(dir.y, -1.0F, 1.0F)) * (1.0F / kPi)};
}

vec3 EnvironmentMap::radiance(vec3 dir_to) const {
  const Image& image = *environment_.radiance;
  const vec2 uv = uvFromDir(dir_to);
  const float x = uv.x * static_cast<float>(image.width) - 0.5F, y = uv.y * static_cast<float>(image.height) - 0.5F;
  const float left = std::floor(x), top = std::floor(y);
  const float fx = x - left, fy = y - top;
  const int i = static_cast<int>(left), j = static_cast<int>(top);
  const auto texel = [&](int dx, int dy) {
    return image.rgb((i + dx + image.width) % image.width, std::clamp(j + dy, 0, image.height - 1));
  };
  return environment_.scale *
         ((1 - fy) * ((1 - fx) * texel(0, 0) + fx * texel(1, 0)) + fy * ((1 - fx) * texel(0, 1) + fx * texel(1, 1)));
}

vec3 EnvironmentMap::sample(vec2 u, float& pdf_solid_angle) const {
  const auto [uv, pdf_square] = distribution_.sample(u);
  const float phi = (uv.x - 0.5F) * 2.0F * kPi, theta = uv.y * kPi;
  const float sin_theta = std::sin(theta);
  const float x = sin_theta * std::sin(phi), z = -sin_theta * std::cos(phi);
  pdf_solid_angle = sin_theta > 0.0F ? pdf_square / (2.0F * kPi * kPi * sin_theta) : 0.0F;
  return {x * cos_rotation_ + z * sin_rotation_, std::cos(theta), -x * sin_rotation_ + z * cos_rotation_};
}

float EnvironmentMap::pdf(vec3 dir_to) const {
  const float sin_theta = std::sqrt(std::max(1.0F - dir_to.y * dir_to.y, 0.0F));
  return sin_theta > 0.0F ? distribution_.pdf(uvFromDir(dir_to)) / (2.0F * kPi * kPi * sin_theta) : 0.0F;
}

}  // namespace nephroid
