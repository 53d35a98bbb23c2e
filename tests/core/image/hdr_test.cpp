#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/image/image_files.h"

namespace nephroid {
namespace {

using ::testing::HasSubstr;
using namespace std::string_literals;

std::string makeHeader(int width, int height, const std::string& extra = "") {
  return "#?RADIANCE\n" + extra + "FORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
         std::to_string(width) + "\n";
}

Image decode(const std::string& file) { return std::get<Image>(decodeImage(makeBytes(file), "the image")); }

/// RGBE (128, 64, 32, 129): (128, 64, 32) × 2^(129 − 136) = (1, 0.5, 0.25).
const std::string kPixel = "\x80\x40\x20\x81";
const vec3 kValue(1.0F, 0.5F, 0.25F);

/// One scan line of the newer coding, each plane one run.
std::string makeRunLine(int width) {
  std::string line = {2, 2, static_cast<char>(width >> 8), static_cast<char>(width & 0xff)};
  for (const char value : kPixel) line += {static_cast<char>(128 + width), value};
  return line;
}

TEST(Hdr, FlatPixelsAreRead) {
  const Image image = decode(makeHeader(2, 1) + kPixel + "\0\0\0\0"s);
  EXPECT_EQ(image.channels, 3);
  EXPECT_EQ(image.rgb(0, 0), kValue);
  EXPECT_EQ(image.rgb(1, 0), vec3(0.0F));
}

TEST(Hdr, NewRunsAreRead) {
  const Image image = decode(makeHeader(10, 2) + makeRunLine(10) + makeRunLine(10));
  ASSERT_EQ(image.width, 10);
  ASSERT_EQ(image.height, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 10; ++x) EXPECT_EQ(image.rgb(x, y), kValue);
}

TEST(Hdr, OldRunsAreRead) {
  // 1 pixel, 4 repeats, then black and 256 × 1 + 2 repeats of it (two run pixels in a row: low byte first).
  const std::string old = kPixel + "\1\1\1\4" + "\0\0\0\0\1\1\1\2\1\1\1\1"s;
  const Image image = decode(makeHeader(264, 1) + old);
  for (int x = 0; x < 264; ++x) EXPECT_EQ(image.rgb(x, 0), x < 5 ? kValue : vec3(0.0F)) << x;
}

TEST(Hdr, ExposureIsDividedOut) {
  const Image image = decode(makeHeader(1, 1, "EXPOSURE=2\nEXPOSURE= 4.0\n") + kPixel);
  EXPECT_EQ(image.rgb(0, 0), kValue / 8.0F);
  for (const char* bad : {"EXPOSURE=0\n", "EXPOSURE=-1\n", "EXPOSURE=x\n", "EXPOSURE=nan\n", "EXPOSURE=1e999\n"})
    EXPECT_THAT(getRefusal(makeBytes(makeHeader(1, 1, bad) + kPixel)), HasSubstr("EXPOSURE")) << bad;
}

TEST(Hdr, LargestExponentStaysFinite) {
  for (const float value : decode(makeHeader(1, 1) + "\xff\xff\xff\xff"s).pixels) EXPECT_TRUE(std::isfinite(value));
}

TEST(Hdr, EveryTruncationIsRefused) {
  for (const std::string& file :
       {makeHeader(3, 1) + kPixel + kPixel + kPixel, makeHeader(10, 2) + makeRunLine(10) + makeRunLine(10),
        makeHeader(16, 1) + kPixel + "\1\1\1\17"})
    for (std::size_t size = 11; size < file.size(); ++size)
      EXPECT_NE(getRefusal(makeBytes(file.substr(0, size))), "decoded") << size;
}

TEST(Hdr, RunsThatDoNotFitAreRefused) {
  std::string too_long = makeRunLine(10), empty = makeRunLine(10);
  too_long[4] = static_cast<char>(128 + 11);
  empty[4] = 0;  // a library of the field loops for ever here
  EXPECT_THAT(getRefusal(makeBytes(makeHeader(10, 1) + too_long)), HasSubstr("does not fit"));
  EXPECT_THAT(getRefusal(makeBytes(makeHeader(10, 1) + empty)), HasSubstr("does not fit"));
  EXPECT_THAT(getRefusal(makeBytes(makeHeader(4, 1) + kPixel + "\1\1\1\4")), HasSubstr("does not fit"));
  EXPECT_THAT(getRefusal(makeBytes(makeHeader(4, 1) + "\1\1\1\4" + kPixel)), HasSubstr("does not fit"));
  EXPECT_THAT(getRefusal(makeBytes(makeHeader(9, 1) + makeRunLine(10))), HasSubstr("scan line"));
}

TEST(Hdr, OtherLayoutsAndSizesAreRefused) {
  EXPECT_THAT(getRefusal(makeBytes("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n" + kPixel)),
              HasSubstr("32-bit_rle_rgbe"));
  EXPECT_THAT(getRefusal(makeBytes("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+Y 1 +X 1\n" + kPixel)),
              HasSubstr("-Y rows +X columns"));
  for (const auto& [width, height] : {std::pair{0, 1}, {1, -1}, {65537, 1}, {65536, 65536}})
    EXPECT_NE(getRefusal(makeBytes(makeHeader(width, height) + kPixel)), "decoded");
}

}  // namespace
}  // namespace nephroid
