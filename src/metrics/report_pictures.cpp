#include "metrics/report_pictures.h"

#include <array>
#include <cmath>
#include <span>

#include <glm/gtc/packing.hpp>

namespace nephroid {
namespace {

/// Between equally spaced colours. @param t  in [0, 1]
vec3 interpolate(std::span<const vec3> colours, float t) {
  const float place = t * static_cast<float>(colours.size() - 1);
  const std::size_t index = std::min(static_cast<std::size_t>(place), colours.size() - 2);
  return mix(colours[index], colours[index + 1], place - static_cast<float>(index));
}

int findExponent(const Image& picture) {
  float largest = 0.0F;
  for (const float value : picture.pixels)
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  return largest > 0.0F ? std::ilogb(largest) - 14 : 0;
}

}  // namespace

PackedPicture packPicture(const Image& picture) {
  PackedPicture packed{Image(picture.width, 2 * picture.height, 3), findExponent(picture)};
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const vec3 rgb = picture.rgb(x, y);
      for (int c = 0; c < 3; ++c) {
        const std::uint16_t half = glm::packHalf1x16(std::ldexp(rgb[c], -packed.exponent));
        packed.bytes.at(x, y)[c] = static_cast<float>(half >> 8) / 255.0F;
        packed.bytes.at(x, picture.height + y)[c] = static_cast<float>(half & 0xff) / 255.0F;
      }
    }
  return packed;
}

vec3 ColourScale::colour(float value) const {
  // Of either the lightness is monotone, or so from the middle on: they read without colour, too.
  static constexpr std::array kRising{vec3(0.0F, 0.0F, 0.02F), vec3(0.25F, 0.06F, 0.42F), vec3(0.72F, 0.18F, 0.36F),
                                      vec3(0.98F, 0.58F, 0.20F), vec3(1.0F, 1.0F, 0.85F)};
  static constexpr std::array kDiverging{vec3(0.05F, 0.20F, 0.60F), vec3(0.96F, 0.96F, 0.96F),
                                         vec3(0.70F, 0.08F, 0.10F)};
  if (std::isnan(value)) return {0.35F, 0.50F, 0.60F};
  const float place = logarithmic ? std::log(std::max(value, lower) / lower) / std::log(upper / lower)
                                  : (value - lower) / (upper - lower);
  const float t = std::clamp(place, 0.0F, 1.0F);
  return diverging ? interpolate(kDiverging, t) : interpolate(kRising, t);
}

Image drawMap(const Image& map, const ColourScale& scale) {
  Image drawn(map.width, map.height, 3);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) drawn.setRgb(x, y, scale.colour(*map.at(x, y)));
  return drawn;
}

}  // namespace nephroid
