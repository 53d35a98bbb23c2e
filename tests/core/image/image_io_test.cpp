#include "core/image/image_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/image/image_files.h"
#include "core/image/tonemap.h"

namespace nephroid {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(DecodeImage, NamesFormatsThatItDoesNotRead) {
  EXPECT_THAT(getRefusal(makeBytes("\xabKTX 20\xbb\r\n\x1a\n....")), HasSubstr("KTX2 images are not supported"));
  EXPECT_THAT(getRefusal(makeBytes("GIF89a")), HasSubstr("GIF images are not supported"));
  EXPECT_THAT(getRefusal(makeBytes(std::string_view("II*\0", 4))), HasSubstr("TIFF images are not supported"));
}

TEST(DecodeImage, RefusesWhatIsNoImage) {
  EXPECT_THAT(getRefusal({}), StartsWith("the image: not an image that Nephroid knows (0 bytes"));
  EXPECT_THAT(getRefusal(makeBytes("RIFF....WAVE")), HasSubstr("expected PNG, JPEG, WebP, EXR or Radiance HDR"));
}

TEST(DecodeImage, RefusesBareSignatures) {
  using namespace std::string_view_literals;
  for (const auto signature : {"\x89PNG\r\n\x1a\n"sv, "\xff\xd8\xff"sv, "RIFF\0\0\0\0WEBP"sv, "\x76\x2f\x31\x01"sv,
                               "#?RADIANCE"sv, "#?RGBE\n"sv})
    EXPECT_THAT(getRefusal(makeBytes(signature)), HasSubstr("damaged")) << signature;
}

TEST(LoadImage, NamesAMissingFile) { EXPECT_THROW(loadImage("/nonexistent/a.png"), InputError); }

TEST(ToLinear, DecodesSrgbOrScales) {
  const ByteImage bytes{.width = 1, .height = 2, .pixels = {0, 128, 255, 7, 1, 2, 3, 255}};
  const Image coded = toLinear(DecodedImage(bytes));
  ASSERT_EQ(coded.channels, 3);
  EXPECT_EQ(coded.rgb(0, 0), vec3(0.0F, linearFromSrgb(128.0F / 255.0F), 1.0F));
  const Image plain = toLinear(DecodedImage(bytes), false);
  EXPECT_EQ(plain.rgb(0, 1), vec3(1.0F, 2.0F, 3.0F) / 255.0F);
}

TEST(ToLinear, DropsTheAlphaOfFloatImages) {
  Image rgba(1, 1, 4);
  rgba.pixels = {1.0F, 2.0F, 3.0F, 0.5F};
  EXPECT_EQ(toLinear(DecodedImage(rgba)).pixels, (std::vector<float>{1.0F, 2.0F, 3.0F}));
}

}  // namespace
}  // namespace nephroid
