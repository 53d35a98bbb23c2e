// Images in memory: one float image type, 8-bit textures, and the stack of layers that a render yields.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/math.h"

namespace nephroid {

/// Linear float image, `height × width × channels`, interleaved, row 0 on top.
struct Image {
  int width = 0, height = 0, channels = 0;
  std::vector<float> pixels;

  Image() = default;
  Image(int w, int h, int c, float value = 0.0F)
      : width(w), height(h), channels(c), pixels(static_cast<std::size_t>(w) * h * c, value) {}

  bool empty() const { return pixels.empty(); }
  float* at(int x, int y) { return pixels.data() + (static_cast<std::size_t>(y) * width + x) * channels; }
  const float* at(int x, int y) const { return pixels.data() + (static_cast<std::size_t>(y) * width + x) * channels; }
  /// RGB of a pixel; one channel is spread over all three.
  vec3 rgb(int x, int y) const {
    const float* p = at(x, y);
    return channels >= 3 ? vec3(p[0], p[1], p[2]) : vec3(p[0]);
  }
  void setRgb(int x, int y, vec3 v) {
    float* p = at(x, y);
    p[0] = v.x, p[1] = v.y, p[2] = v.z;
  }
};

/// 8-bit image, `height × width × 4`, RGBA as stored in the file (sRGB or linear, as its use says), row 0 on top.
struct ByteImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
};

/// What a decoder yields: 8 bits from PNG, JPEG, WebP; linear float (RGB or RGBA) from EXR and HDR.
using DecodedImage = std::variant<ByteImage, Image>;

/// One named layer of a render.
struct Layer {
  std::string name;  ///< name of DESIGN's AOV list: "beauty", "caustic", "normal", …
  Image image;       ///< 3 channels; 1 for `depth` and `id`
};

/// The layers of one picture, all of one size, with what is known about how they were made.
struct LayeredImage {
  int width = 0, height = 0;
  std::vector<Layer> layers;
  std::map<std::string, std::string> metadata;

  const Image* find(std::string_view name) const {
    for (const Layer& layer : layers)
      if (layer.name == name) return &layer.image;
    return nullptr;
  }
};

}  // namespace nephroid
