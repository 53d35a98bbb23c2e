#include "frame/display_pass.h"

#include <cmath>
#include <cstring>
#include <vector>

#include "core/image/tonemap.h"
#include "support/gpu_fixture.h"

namespace nephroid {
namespace {

class DisplayPassTest : public testing::GpuTest {
 protected:
  static gpu::Image upload(const Image& image) {
    gpu::Image result(device(),
                      {.format = VK_FORMAT_R32G32B32A32_SFLOAT,
                       .width = static_cast<std::uint32_t>(image.width),
                       .height = static_cast<std::uint32_t>(image.height),
                       .usage = VK_IMAGE_USAGE_SAMPLED_BIT},
                      "layer");
    std::vector<vec4> texels;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) texels.emplace_back(image.rgb(x, y), 0.0F);
    gpu::CommandRecorder recorder(device());
    recorder.begin();
    recorder.upload(result, std::as_bytes(std::span(texels)));
    recorder.submit();
    return result;
  }

  static Image run(std::vector<Image> layers, float weight, const std::optional<FrameDisplay>& display) {
    std::vector<gpu::Image> images;
    for (const Image& layer : layers) images.push_back(upload(layer));
    std::vector<const gpu::Image*> pointers;
    for (const gpu::Image& image : images) pointers.push_back(&image);
    const int width = layers[0].width, height = layers[0].height;
    DisplayPass pass(device(), static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
    gpu::CommandRecorder recorder(device());
    recorder.begin();
    pass.record(recorder, pointers, weight, display);
    recorder.submit();
    const std::vector<std::byte> bytes = gpu::readBack(device(), pass.picture());
    std::vector<vec4> texels(bytes.size() / sizeof(vec4));
    std::memcpy(static_cast<void*>(texels.data()), bytes.data(), bytes.size());
    Image result(width, height, 3);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) result.setRgb(x, y, vec3(texels[static_cast<std::size_t>(y * width + x)]));
    return result;
  }
};

/// Colours over `octaves` of brightness, a few of them black, negative or no number at all.
Image makeGradient(int width, int height, float octaves, float scale) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float t = static_cast<float>(y * width + x) / static_cast<float>(width * height);
      const float value = scale * std::exp2(octaves * t);
      image.setRgb(x, y, vec3(value, 0.5F * value, (x % 3 == 0 ? 2.0F : 0.0F) * value));
    }
  image.setRgb(0, 0, vec3(0.0F));
  image.setRgb(1, 0, vec3(-1.0F, -2.0F, -1.0F));
  image.setRgb(2, 0, vec3(std::nanf("")));
  return image;
}

void expectNear(const Image& a, const Image& b, float tolerance) {
  ASSERT_EQ(a.pixels.size(), b.pixels.size());
  for (std::size_t i = 0; i < a.pixels.size(); ++i) ASSERT_NEAR(a.pixels[i], b.pixels[i], tolerance) << i;
}

TEST_F(DisplayPassTest, RadianceIsTheWeightedSum) {
  const Image a = makeGradient(9, 5, 3.0F, 1.0F);
  Image b(9, 5, 3), c(9, 5, 3);
  for (std::size_t i = 0; i < b.pixels.size(); ++i) {
    b.pixels[i] = 0.25F * static_cast<float>(i);
    c.pixels[i] = -1.0F;
  }
  const Image sum = run({a, b, c}, 0.5F, std::nullopt);
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    if (!std::isnan(a.pixels[i])) {
      const float expected = 0.5F * (a.pixels[i] + b.pixels[i] + c.pixels[i]);
      ASSERT_NEAR(sum.pixels[i], expected, 1e-6F * (1.0F + std::abs(expected))) << i;
    }
}

TEST_F(DisplayPassTest, AGivenExposureShowsWhatTheFileShows) {
  const Image radiance = makeGradient(33, 17, 12.0F, 1e-3F);
  for (const ToneMap tone_map : {ToneMap::kClamp, ToneMap::kFilmic})
    for (const float ev : {-3.0F, 0.0F, 2.5F}) {
      SCOPED_TRACE(ev);
      const Image shown = run({radiance}, 1.0F, FrameDisplay{.exposure_ev = ev, .tone_map = tone_map});
      expectNear(shown, toDisplay(radiance, ev, tone_map), 2e-5F);
    }
}

TEST_F(DisplayPassTest, WithoutCodingItIsLinear) {
  const Image radiance = makeGradient(8, 8, 2.0F, 0.1F);
  const Image linear = run({radiance}, 1.0F, FrameDisplay{.exposure_ev = 1.0F, .coded = false});
  Image expected(8, 8, 3);
  for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
    const float value = 2.0F * radiance.pixels[i];
    expected.pixels[i] = value > 0.0F ? std::min(value, 1.0F) : 0.0F;
  }
  expectNear(linear, expected, 1e-6F);
}

TEST_F(DisplayPassTest, AutomaticExposureIsThatOfTheFileToHalfACell) {
  // From starlight to a focused sun, with and without highlights that bound it.
  for (const float scale : {1e-6F, 1.0F, 1e4F})
    for (const float octaves : {0.0F, 4.0F, 15.0F, 30.0F}) {
      SCOPED_TRACE(::testing::Message() << scale << " " << octaves);
      const Image radiance = makeGradient(64, 48, octaves - 20.0F * (octaves > 20.0F ? 1.0F : 0.0F), scale);
      const Image linear = run({radiance}, 1.0F, FrameDisplay{.coded = false});
      // A pixel that is not clipped tells the exposure.
      const float ev = computeAutoExposure(radiance);
      double taken = 0.0;
      for (int x = 3; x < 64; ++x)
        if (linear.at(x, 0)[0] > 0.0F && linear.at(x, 0)[0] < 0.99F)
          taken = std::log2(static_cast<double>(linear.at(x, 0)[0]) / radiance.at(x, 0)[0]);
      ASSERT_NE(taken, 0.0);
      EXPECT_NEAR(taken, ev, 1.0 / 16.0);
    }
}

TEST_F(DisplayPassTest, ABlackPictureStaysBlack) {
  const Image shown = run({Image(5, 4, 3)}, 1.0F, FrameDisplay{});
  for (const float value : shown.pixels) ASSERT_EQ(value, 0.0F);
}

}  // namespace
}  // namespace nephroid
