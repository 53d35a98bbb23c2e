#include "api/display.h"

#include <fmt/format.h>

#include <algorithm>

#include "nephroid/error.h"

namespace nephroid {
namespace {

/// A pixel where the camera sees nothing has no depth: renderers write 0 or infinity there.
bool isDepth(float depth) { return std::isfinite(depth) && depth > 0; }

template <class Convert>
Image mapPixels(const Image& image, Convert convert) {
  Image display(image.width, image.height, 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) display.setRgb(x, y, convert(image.rgb(x, y)));
  return display;
}

Image displayDepth(const Image& image) {
  float near = kInfinity, far = 0;
  for (const float depth : image.pixels) {
    if (!isDepth(depth)) continue;
    near = std::min(near, depth);
    far = std::max(far, depth);
  }
  // The farthest surface stays grey, so that it differs from the black where there is none.
  constexpr float kFarGrey = 0.1F;
  const float range = far > near ? far - near : 1.0F;
  return mapPixels(
      image, [&](vec3 p) { return isDepth(p.x) ? vec3(1.0F - (1.0F - kFarGrey) * (p.x - near) / range) : vec3(0); });
}

Image displayPosition(const Image& image) {
  Bounds bounds;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (isFinite(image.rgb(x, y))) bounds.add(image.rgb(x, y));
  const vec3 extent = bounds.extent();
  return mapPixels(image, [&](vec3 p) {
    if (!isFinite(p)) return vec3(0);
    vec3 display(0);
    for (int c = 0; c < 3; ++c) display[c] = extent[c] > 0 ? (p[c] - bounds.lower[c]) / extent[c] : 0.5F;
    return display;
  });
}

Image displayId(const Image& image) {
  return mapPixels(image, [](vec3 p) {
    if (!(p.x > 0) || !std::isfinite(p.x)) return vec3(0);
    // Fibonacci hashing spreads neighbouring numbers over the whole cube; the offset keeps clear of black.
    const auto hash = static_cast<std::uint32_t>(static_cast<std::int64_t>(p.x)) * 2654435769U;
    const auto channel = [hash](int shift) { return 0.2F + 0.8F * static_cast<float>(hash >> shift & 255U) / 255.0F; };
    return vec3(channel(24), channel(16), channel(8));
  });
}

float exposureOf(const LayeredImage& image, const Image& layer, const DisplayOptions& options) {
  if (options.exposure_ev) return *options.exposure_ev;
  const Image* beauty = image.find("beauty");
  return computeAutoExposure(beauty != nullptr ? *beauty : layer);
}

}  // namespace

Image displayLayer(const LayeredImage& image, std::string_view layer, const DisplayOptions& options) {
  const Image* found = image.find(layer);
  if (found == nullptr) throw UsageError(fmt::format("the picture has no layer '{}'", layer));
  if (layer == "normal") return mapPixels(*found, [](vec3 n) { return glm::clamp(0.5F + 0.5F * n, 0.0F, 1.0F); });
  if (layer == "albedo") return toDisplay(*found, 0.0F, ToneMap::kClamp);
  if (layer == "depth") return displayDepth(*found);
  if (layer == "position") return displayPosition(*found);
  if (layer == "id") return displayId(*found);
  Image radiance = mapPixels(*found, [](vec3 p) { return p; });
  if (layer.starts_with("irradiance"))
    for (float& value : radiance.pixels) value /= kPi;
  return toDisplay(radiance, exposureOf(image, radiance, options), options.tone_map);
}

}  // namespace nephroid
