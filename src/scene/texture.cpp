#include "scene/texture.h"

#include <array>
#include <cmath>

#include "core/image/tonemap.h"

namespace nephroid {
namespace {

int wrapTexel(int i, int size, Wrap mode) {
  switch (mode) {
    case Wrap::kClamp:
      return std::clamp(i, 0, size - 1);
    case Wrap::kMirror: {
      const int period = 2 * size;
      const int m = ((i % period) + period) % period;
      return m < size ? m : period - 1 - m;
    }
    case Wrap::kRepeat:
      break;
  }
  return ((i % size) + size) % size;
}

const std::array<float, 256>& srgbTable() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t{};
    for (int i = 0; i < 256; ++i) t[i] = linearFromSrgb(static_cast<float>(i) / 255.0F);
    return t;
  }();
  return table;
}

vec4 fetch(const ByteImage& image, int x, int y, bool srgb) {
  const std::uint8_t* p = image.pixels.data() + (static_cast<std::size_t>(y) * image.width + x) * 4;
  const vec4 raw = vec4(p[0], p[1], p[2], p[3]) * (1.0F / 255.0F);
  if (!srgb) return raw;
  const auto& table = srgbTable();
  return {table[p[0]], table[p[1]], table[p[2]], raw.w};
}

vec4 fetch(const Image& image, int x, int y, bool /*srgb*/) {
  const float* p = image.at(x, y);
  if (image.channels == 4) return {p[0], p[1], p[2], p[3]};
  return {image.rgb(x, y), 1.0F};
}

template <class Pixels>
vec4 sample(const Pixels& image, const TextureRef& reference, vec2 uv, bool srgb) {
  const float x = uv.x * static_cast<float>(image.width), y = uv.y * static_cast<float>(image.height);
  const auto texel = [&](int i, int j) {
    return fetch(image, wrapTexel(i, image.width, reference.wrap_u), wrapTexel(j, image.height, reference.wrap_v),
                 srgb);
  };
  if (reference.nearest) return texel(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
  const float left = std::floor(x - 0.5F), top = std::floor(y - 0.5F);
  const float fx = x - 0.5F - left, fy = y - 0.5F - top;
  const int i = static_cast<int>(left), j = static_cast<int>(top);
  return (1 - fy) * ((1 - fx) * texel(i, j) + fx * texel(i + 1, j)) +
         fy * ((1 - fx) * texel(i, j + 1) + fx * texel(i + 1, j + 1));
}

}  // namespace

vec4 sampleTexture(const TextureImage& texture, const TextureRef& reference, vec2 texcoord, bool srgb) {
  vec3 uv = reference.uv_from_texcoord * vec3(texcoord, 1.0F);
  // Coordinates beyond a million periods carry no position any more, and must not overflow the integer texel index.
  if (!(std::abs(uv.x) < 1e6F)) uv.x = 0.0F;
  if (!(std::abs(uv.y) < 1e6F)) uv.y = 0.0F;
  if (reference.wrap_u == Wrap::kRepeat) uv.x -= std::floor(uv.x);
  if (reference.wrap_v == Wrap::kRepeat) uv.y -= std::floor(uv.y);
  return std::visit([&](const auto& image) { return sample(image, reference, vec2(uv), srgb); }, texture.image);
}

}  // namespace nephroid
