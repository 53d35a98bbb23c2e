#include <gmock/gmock.h>
#include <gtest/gtest.h>
// jpeglib.h needs FILE and size_t declared before it.
#include <cstddef>
#include <cstdio>

#include <jpeglib.h>
#include <webp/encode.h>

#include <cstdlib>
#include <cstring>

#include "core/image/image_files.h"

namespace nephroid {
namespace {

using ::testing::HasSubstr;

/// Smooth, so that JPEG keeps it within a few steps. Interleaved, `channels` per pixel.
std::vector<std::uint8_t> makeSmooth(int width, int height, int channels) {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c) pixels.push_back(static_cast<std::uint8_t>(40 + 2 * x + y + 20 * c));
  return pixels;
}

std::vector<std::byte> encodeJpeg(int width, int height, int channels, J_COLOR_SPACE space, bool progressive = false) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &buffer, &size);
  jpeg.image_width = static_cast<JDIMENSION>(width);
  jpeg.image_height = static_cast<JDIMENSION>(height);
  jpeg.input_components = channels;
  jpeg.in_color_space = space;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 95, TRUE);
  if (progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  std::vector<std::uint8_t> pixels = makeSmooth(width, height, channels);
  while (jpeg.next_scanline < jpeg.image_height) {
    JSAMPROW row = pixels.data() + static_cast<std::size_t>(jpeg.next_scanline) * width * channels;
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  const auto* begin = reinterpret_cast<const std::byte*>(buffer);
  std::vector<std::byte> bytes(begin, begin + size);
  jpeg_destroy_compress(&jpeg);
  std::free(buffer);  // allocated by libjpeg with malloc
  return bytes;
}

void expectSmooth(std::span<const std::byte> bytes, int width, int height, int channels) {
  const ByteImage image = std::get<ByteImage>(decodeImage(bytes, "the image"));
  ASSERT_EQ(image.width, width);
  ASSERT_EQ(image.height, height);
  const std::vector<std::uint8_t> expected = makeSmooth(width, height, channels);
  for (std::size_t i = 0; i < expected.size() / static_cast<std::size_t>(channels); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t source = i * static_cast<std::size_t>(channels) + (channels == 1 ? 0 : c);
      ASSERT_NEAR(image.pixels[4 * i + c], expected[source], 4) << i;
    }
    ASSERT_EQ(image.pixels[4 * i + 3], 255);
  }
}

TEST(Jpeg, RgbGreyAndProgressiveAreRead) {
  expectSmooth(encodeJpeg(33, 17, 3, JCS_RGB), 33, 17, 3);
  expectSmooth(encodeJpeg(33, 17, 1, JCS_GRAYSCALE), 33, 17, 1);
  expectSmooth(encodeJpeg(33, 17, 3, JCS_RGB, true), 33, 17, 3);
}

TEST(Jpeg, CmykIsRefusedByName) { EXPECT_THAT(getRefusal(encodeJpeg(8, 8, 4, JCS_CMYK)), HasSubstr("JPEG in CMYK")); }

TEST(Jpeg, EveryTruncationIsRefused) {
  for (const bool progressive : {false, true}) {
    const std::vector<std::byte> bytes = encodeJpeg(24, 24, 3, JCS_RGB, progressive);
    // Without the two bytes of the end marker the picture is whole, but nobody can know that.
    for (std::size_t size = 3; size < bytes.size(); ++size)
      EXPECT_THAT(getRefusal(std::span(bytes).first(size)), HasSubstr("damaged JPEG image")) << size;
  }
}

TEST(Jpeg, HugeSizeInASmallFileIsRefusedAtOnce) {
  std::vector<std::byte> bytes = encodeJpeg(8, 8, 3, JCS_RGB);
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t frame = text.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  for (const std::size_t offset : {5U, 7U}) bytes[frame + offset] = std::byte{0x3f};  // 16136 x 16136
  EXPECT_THAT(getRefusal(bytes), HasSubstr("ends too early for its width and height"));
}

std::vector<std::byte> encodeWebp(const std::vector<std::uint8_t>& rgba, int width, int height, bool lossless) {
  std::uint8_t* buffer = nullptr;
  const std::size_t size = lossless ? WebPEncodeLosslessRGBA(rgba.data(), width, height, width * 4, &buffer)
                                    : WebPEncodeRGBA(rgba.data(), width, height, width * 4, 90.0F, &buffer);
  const auto* begin = reinterpret_cast<const std::byte*>(buffer);
  std::vector<std::byte> bytes(begin, begin + size);
  WebPFree(buffer);
  return bytes;
}

TEST(Webp, LosslessRoundTripIsExact) {
  const std::vector<std::uint8_t> pixels = makeSmooth(20, 10, 4);
  const ByteImage image = std::get<ByteImage>(decodeImage(encodeWebp(pixels, 20, 10, true), "x"));
  EXPECT_EQ(image.width, 20);
  EXPECT_EQ(image.height, 10);
  EXPECT_EQ(image.pixels, pixels);
}

TEST(Webp, LossyIsRead) {
  const std::vector<std::uint8_t> grey(16 * 16 * 4, 128);
  const ByteImage image = std::get<ByteImage>(decodeImage(encodeWebp(grey, 16, 16, false), "x"));
  ASSERT_EQ(image.pixels.size(), grey.size());
  for (std::size_t i = 0; i < grey.size(); ++i) EXPECT_NEAR(image.pixels[i], 128, 3);
}

TEST(Webp, EveryTruncationIsRefused) {
  for (const bool lossless : {true, false}) {
    const std::vector<std::byte> bytes = encodeWebp(makeSmooth(20, 10, 4), 20, 10, lossless);
    for (std::size_t size = 12; size + 1 < bytes.size(); ++size)  // the last byte may be padding
      EXPECT_NE(getRefusal(std::span(bytes).first(size)), "decoded") << size;
  }
}

TEST(Webp, AnimationIsRefusedByName) {
  // An extended header (VP8X) with the animation flag, an ANIM chunk, and no frame.
  using namespace std::string_view_literals;
  const auto animation = "RIFF\x24\0\0\0WEBPVP8X\x0a\0\0\0\x02\0\0\0\x07\0\0\x07\0\0ANIM\x06\0\0\0\0\0\0\0\0\0"sv;
  EXPECT_THAT(getRefusal(makeBytes(animation)), HasSubstr("animated WebP"));
}

}  // namespace
}  // namespace nephroid
