#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
#include <ImfTiledOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>

#include "core/file.h"
#include "core/image/image_files.h"

namespace nephroid {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

Image makeNoise(int width, int height, int channels, unsigned seed) {
  Image image(width, height, channels);
  std::mt19937 random(seed);
  for (float& v : image.pixels)
    v = std::ldexp(static_cast<float>(random()) - 2e9F, static_cast<int>(random() % 40) - 60);
  return image;
}

LayeredImage makeLayers(int width, int height) {
  LayeredImage image;
  image.width = width, image.height = height;
  image.layers = {{"beauty", makeNoise(width, height, 3, 1)},           {"caustic", makeNoise(width, height, 3, 2)},
                  {"specular_caustic", makeNoise(width, height, 3, 3)}, {"depth", makeNoise(width, height, 1, 4)},
                  {"id", Image(width, height, 1, 16777213.0F)},         {"noise", makeNoise(width, height, 1, 5)}};
  // "version" and "type" have meanings of their own in EXR, which ours must not touch.
  image.metadata = {
      {"technique", "reference"}, {"version", "0.1.0"}, {"type", "x"}, {"scene", "Brücke\nzwei"}, {"e", ""}};
  return image;
}

bool areSameBits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

Image decodeFile(const std::filesystem::path& path) { return std::get<Image>(loadImage(path)); }

/// A file of these FLOAT channels, all of the values of `image`'s first channels in order.
void writeChannels(const std::filesystem::path& path, const Image& image, std::vector<std::string> names,
                   const Imf::Header& form, bool tiled = false) {
  Imf::Header header(form);
  Imf::FrameBuffer source;
  const Imath::Box2i window = header.dataWindow();
  for (std::size_t c = 0; c < names.size(); ++c) {
    header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
    const std::size_t pixel_size = static_cast<std::size_t>(image.channels) * sizeof(float);
    source.insert(names[c], Imf::Slice::Make(Imf::FLOAT, image.pixels.data() + c, window, pixel_size,
                                             pixel_size * static_cast<std::size_t>(image.width)));
  }
  if (tiled) {
    header.setTileDescription(Imf::TileDescription(7, 5, Imf::MIPMAP_LEVELS));
    Imf::TiledOutputFile file(path.c_str(), header);
    file.setFrameBuffer(source);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);  // level 0 only: others are not needed
    return;
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(source);
  file.writePixels(image.height);
}

TEST(Exr, RoundTripKeepsLayersBitsAndMetadata) {
  const TemporaryPath path(".exr");
  const LayeredImage image = makeLayers(37, 300);  // more rows than are read at a time
  writeExr(path.get(), image);
  const LayeredImage back = readExr(path.get());
  EXPECT_EQ(back.width, 37);
  EXPECT_EQ(back.height, 300);
  EXPECT_EQ(back.metadata, image.metadata);
  ASSERT_EQ(back.layers.size(), image.layers.size());
  EXPECT_EQ(back.layers.front().name, "beauty");
  for (const Layer& layer : image.layers) {
    const Image* found = back.find(layer.name);
    ASSERT_NE(found, nullptr) << layer.name;
    EXPECT_EQ(found->channels, layer.image.channels) << layer.name;
    EXPECT_TRUE(areSameBits(found->pixels, layer.image.pixels)) << layer.name;
  }
}

TEST(Exr, RoundTripKeepsNaNForWhoeverMeasures) {
  const TemporaryPath path(".exr");
  LayeredImage image{.width = 1, .height = 1, .layers = {{"beauty", Image(1, 1, 3, kNaN)}}, .metadata = {}};
  writeExr(path.get(), image);
  EXPECT_TRUE(std::isnan(readExr(path.get()).layers[0].image.pixels[0]));
}

TEST(Exr, EqualPicturesGiveEqualFiles) {
  const TemporaryPath a("a.exr"), b("b.exr");
  writeExr(a.get(), makeLayers(20, 20));
  writeExr(b.get(), makeLayers(20, 20));
  EXPECT_EQ(readFile(a.get()), readFile(b.get()));
}

TEST(Exr, HalfRoundsClampsAndKeepsNumbersOfObjects) {
  const TemporaryPath path(".exr");
  LayeredImage image{.width = 3,
                     .height = 1,
                     .layers = {{"beauty", Image(3, 1, 3)}, {"id", Image(3, 1, 1, 100001.0F)}},
                     .metadata = {}};
  image.layers[0].image.pixels = {1.0F, 0.333333F, 1e9F, -1e9F, kInfinity, 65504.0F, 0.0F, kNaN, -2.0F};
  writeExr(path.get(), image, true);
  const LayeredImage back = readExr(path.get());
  const std::vector<float>& beauty = back.find("beauty")->pixels;
  EXPECT_EQ(beauty[0], 1.0F);
  EXPECT_NEAR(beauty[1], 0.333333F, 0.333333F / 2048.0F);
  EXPECT_EQ(beauty[2], 65504.0F);
  EXPECT_EQ(beauty[3], -65504.0F);
  EXPECT_EQ(beauty[4], 65504.0F);
  EXPECT_EQ(beauty[5], 65504.0F);
  EXPECT_TRUE(std::isnan(beauty[7]));
  EXPECT_EQ(back.find("id")->pixels[0], 100001.0F);
}

TEST(Exr, DecodesTheBeautyLayer) {
  const TemporaryPath path(".exr");
  const LayeredImage image = makeLayers(20, 20);
  writeExr(path.get(), image);
  EXPECT_TRUE(areSameBits(decodeFile(path.get()).pixels, image.layers[0].image.pixels));
}

TEST(Exr, DecodedPicturesAreFinite) {
  const TemporaryPath path(".exr");
  LayeredImage image{.width = 1, .height = 1, .layers = {{"beauty", Image(1, 1, 3)}}, .metadata = {}};
  image.layers[0].image.pixels = {kNaN, kInfinity, -kInfinity};
  writeExr(path.get(), image);
  EXPECT_THAT(decodeFile(path.get()).pixels, ElementsAre(0.0F, 65504.0F, 0.0F));
}

TEST(Exr, WriterKeepsTheOldFileOnAFullDiskAndNamesTheCause) {
  try {
    writeExr("/dev/full", makeLayers(8, 8));
    FAIL();
  } catch (const ResourceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/dev/full: cannot write: No space left on device"));
  }
}

TEST(Exr, WriterRefusesLayersOfOtherSizes) {
  const TemporaryPath path(".exr");
  LayeredImage image = makeLayers(8, 8);
  image.layers[1].image = Image(8, 7, 3);
  EXPECT_THROW(writeExr(path.get(), image), InternalError);
  image.layers[1].image = Image(8, 8, 2);
  EXPECT_THROW(writeExr(path.get(), image), InternalError);
  EXPECT_FALSE(std::filesystem::exists(path.get()));
}

TEST(Exr, OffsetDataWindowAndAlphaAreRead) {
  const TemporaryPath path(".exr");
  const Image image = makeNoise(6, 5, 4, 7);
  Imf::Header header(100, 100);
  header.dataWindow() = Imath::Box2i(Imath::V2i(-3, 90), Imath::V2i(2, 94));
  writeChannels(path.get(), image, {"R", "G", "B", "A"}, header);
  const Image back = decodeFile(path.get());
  EXPECT_EQ(back.channels, 4);
  EXPECT_TRUE(areSameBits(back.pixels, image.pixels));
  const LayeredImage layers = readExr(path.get());
  ASSERT_NE(layers.find("A"), nullptr);
  EXPECT_EQ(layers.find("A")->pixels[0], image.pixels[3]);
  EXPECT_EQ(layers.find("beauty")->channels, 3);
}

TEST(Exr, LevelZeroOfTilesIsRead) {
  const TemporaryPath path(".exr");
  const Image image = makeNoise(40, 600, 3, 8);
  Imf::Header header(40, 600);
  writeChannels(path.get(), image, {"R", "G", "B"}, header, true);
  EXPECT_TRUE(areSameBits(decodeFile(path.get()).pixels, image.pixels));
}

TEST(Exr, GreyIsSpreadOverThreeChannels) {
  const TemporaryPath path(".exr");
  Image grey(2, 1, 1);
  grey.pixels = {0.25F, 4.0F};
  writeChannels(path.get(), grey, {"Y"}, Imf::Header(2, 1));
  EXPECT_THAT(decodeFile(path.get()).pixels, ElementsAre(0.25F, 0.25F, 0.25F, 4.0F, 4.0F, 4.0F));
  EXPECT_EQ(readExr(path.get()).find("beauty")->channels, 1);
}

TEST(Exr, VectorsAndOddGroupsAreRead) {
  const TemporaryPath path(".exr");
  const Image image = makeNoise(2, 2, 4, 9);
  writeChannels(path.get(), image, {"normal.X", "normal.Y", "normal.Z", "motion.U"}, Imf::Header(2, 2));
  const LayeredImage back = readExr(path.get());
  EXPECT_EQ(back.find("normal")->channels, 3);
  EXPECT_EQ(back.find("normal")->pixels[1], image.pixels[1]);
  EXPECT_EQ(back.find("motion")->channels, 1);
  EXPECT_THAT(getRefusal(readFile(path.get())), HasSubstr("found channels motion.U, normal.X, normal.Y, normal.Z"));
}

TEST(Exr, LuminanceAndChromaAreConverted) {
  const TemporaryPath path(".exr");
  constexpr int kWidth = 20, kHeight = 300;
  const std::vector<Imf::Rgba> pixels(static_cast<std::size_t>(kWidth) * kHeight, Imf::Rgba(0.5F, 0.25F, 0.125F));
  {
    Imf::RgbaOutputFile file(path.get().c_str(), kWidth, kHeight, Imf::WRITE_YC);
    file.setFrameBuffer(pixels.data(), 1, kWidth);
    file.writePixels(kHeight);
  }
  const Image image = decodeFile(path.get());
  ASSERT_EQ(image.channels, 3);
  ASSERT_EQ(image.pixels.size(), pixels.size() * 3);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      // Luminance is rounded to seven bits or so by the writer; chroma is a half.
      EXPECT_NEAR(image.rgb(x, y).x, 0.5F, 0.01F);
      EXPECT_NEAR(image.rgb(x, y).y, 0.25F, 0.01F);
      EXPECT_NEAR(image.rgb(x, y).z, 0.125F, 0.01F);
    }
  EXPECT_EQ(readExr(path.get()).find("beauty")->channels, 3);
}

TEST(Exr, EveryTruncationIsRefused) {
  const TemporaryPath path(".exr");
  LayeredImage image = makeLayers(16, 40);
  image.layers.resize(1);
  writeExr(path.get(), image);
  const std::vector<std::byte> bytes = readFile(path.get());
  for (std::size_t size = 4; size < bytes.size(); ++size)
    ASSERT_THAT(getRefusal(std::span(bytes).first(size)), HasSubstr("damaged OpenEXR image")) << size;
}

TEST(Exr, FlippedBytesEndInAMessageOrAFinitePicture) {
  const TemporaryPath path(".exr");
  LayeredImage image = makeLayers(16, 40);
  image.layers.resize(2);
  writeExr(path.get(), image);
  const std::vector<std::byte> bytes = readFile(path.get());
  std::mt19937 random(11);
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::byte> broken = bytes;
    // Half of them in the header, where they do most.
    const std::size_t range = i % 2 == 0 ? std::size_t{500} : broken.size();
    broken[random() % range] ^= static_cast<std::byte>(1U << random() % 8U);
    try {
      const DecodedImage decoded = decodeImage(broken, "the image");
      for (const float v : std::get<Image>(decoded).pixels) ASSERT_TRUE(std::isfinite(v));
    } catch (const Error& error) {
      ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

TEST(Exr, AttributeLongerThanTheFileIsRefused) {
  using namespace std::string_view_literals;
  const auto bytes = makeBytes("\x76\x2f\x31\x01\x02\0\0\0comment\0string\0\xf0\xff\xff\x7fshort"sv);
  EXPECT_THAT(getRefusal(bytes), HasSubstr("attribute 'comment' is longer than the file"));
}

/// A file of one ZIP block, and where that block begins (its row, its size, its data).
std::pair<std::vector<std::byte>, std::size_t> makeOneBlock() {
  const TemporaryPath path(".exr");
  LayeredImage image = makeLayers(16, 16);
  image.layers.resize(1);
  image.layers[0].image = Image(16, 16, 3, 0.5F);
  writeExr(path.get(), image);
  const std::vector<std::byte> bytes = readFile(path.get());
  // The table of one offset stands right before the block that it points to.
  for (std::size_t at = 8; at + 8 < bytes.size(); ++at) {
    std::uint64_t offset = 0;
    std::memcpy(&offset, bytes.data() + at - 8, sizeof offset);
    if (offset == at) return {bytes, at};
  }
  return {bytes, 0};
}

TEST(Exr, BlockThatUnpacksToTooLittleIsRefused) {
  // Older libraries fill up such blocks with stray memory.
  const auto [bytes, block] = makeOneBlock();
  ASSERT_GT(block, 0U);
  EXPECT_EQ(getRefusal(bytes), "decoded");
  std::vector<std::byte> empty = bytes;
  std::fill_n(empty.begin() + static_cast<std::ptrdiff_t>(block) + 4, 4, std::byte{0});
  EXPECT_THAT(getRefusal(empty), HasSubstr("a block of pixels has the wrong length"));

  std::vector<std::byte> brief(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(block) + 8);
  const std::vector<Bytef> pixels(16 * 16 * 3 * 4 - 1, 7);  // one byte too few
  std::vector<Bytef> packed(compressBound(static_cast<uLong>(pixels.size())));
  auto size = static_cast<uLongf>(packed.size());
  ASSERT_EQ(compress(packed.data(), &size, pixels.data(), static_cast<uLong>(pixels.size())), Z_OK);
  const auto size_in_file = static_cast<std::uint32_t>(size);
  std::memcpy(brief.data() + block + 4, &size_in_file, sizeof size_in_file);
  for (std::size_t i = 0; i < size; ++i) brief.push_back(static_cast<std::byte>(packed[i]));
  EXPECT_THAT(getRefusal(brief), HasSubstr("a block of pixels has the wrong length"));
}

TEST(Exr, EveryCompressionIsRead) {
  const TemporaryPath path(".exr");
  Image image(50, 70, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i % 97) / 64.0F;
  for (int compression = 0; compression < Imf::DWAA_COMPRESSION; ++compression)
    for (const bool tiled : {false, true}) {
      Imf::Header header(50, 70);
      header.dataWindow() = Imath::Box2i(Imath::V2i(-7, -13), Imath::V2i(42, 56));
      header.compression() = static_cast<Imf::Compression>(compression);
      header.lineOrder() = tiled ? Imf::INCREASING_Y : Imf::DECREASING_Y;
      writeChannels(path.get(), image, {"R", "G", "B"}, header, tiled);
      // B44 leaves 32-bit channels alone, PXR24 keeps 15 bits of the mantissa and these values need fewer.
      EXPECT_TRUE(areSameBits(decodeFile(path.get()).pixels, image.pixels)) << compression << ' ' << tiled;
    }
}

TEST(Exr, PictureThatTheFileCannotHoldIsRefused) {
  const TemporaryPath path(".exr");
  LayeredImage image = makeLayers(16, 16);
  image.layers.resize(1);
  writeExr(path.get(), image);
  std::vector<std::byte> bytes = readFile(path.get());
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t window = text.find("dataWindow") + 11 + 6 + 4;  // name, type, size
  bytes[window + 8 + 1] = std::byte{0x3f};                          // max x: 16143
  bytes[window + 12 + 1] = std::byte{0x3f};
  EXPECT_THAT(getRefusal(bytes), HasSubstr("damaged OpenEXR image"));
  bytes[window + 8 + 2] = std::byte{0x10};
  EXPECT_NE(getRefusal(bytes), "decoded");
}

}  // namespace
}  // namespace nephroid
