#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <limits>

#include "core/file.h"
#include "core/image/image_files.h"

namespace nephroid {
namespace {

using ::testing::HasSubstr;

Image makeGradient(int width, int height) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.setRgb(x, y,
                   vec3(static_cast<float>(x) / 255.0F, static_cast<float>(y) / 255.0F,
                        static_cast<float>((x * 7 + y) % 256) / 255.0F));
  return image;
}

std::vector<std::byte> encode(const Image& image) {
  const TemporaryPath path(".png");
  writePng(path.get(), image);
  return readFile(path.get());
}

/// Any kind of PNG, through libpng's writer.
std::vector<std::byte> encodeRaw(int width, int height, int bit_depth, int colour_type, std::vector<std::uint8_t> rows,
                                 const png_color_16* transparent = nullptr, int interlace = PNG_INTERLACE_NONE) {
  std::vector<std::byte> bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const auto append = [](png_structp writer, png_bytep data, std::size_t size) {
    auto* target = static_cast<std::vector<std::byte>*>(png_get_io_ptr(writer));
    const auto* begin = reinterpret_cast<const std::byte*>(data);
    target->insert(target->end(), begin, begin + size);
  };
  png_set_write_fn(png, &bytes, append, [](png_structp) {});
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bit_depth, colour_type,
               interlace, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  // Stored, not packed: what must be read for the last pixel ends with it.
  png_set_compression_level(png, 0);
  if (transparent != nullptr) png_set_tRNS(png, info, nullptr, 0, transparent);
  png_write_info(png, info);
  const std::size_t row_bytes = png_get_rowbytes(png, info);
  std::vector<png_bytep> pointers;
  for (int y = 0; y < height; ++y) pointers.push_back(rows.data() + static_cast<std::size_t>(y) * row_bytes);
  png_write_image(png, pointers.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

std::vector<std::uint8_t> decodePixels(std::span<const std::byte> bytes) {
  return std::get<ByteImage>(decodeImage(bytes, "the image")).pixels;
}

TEST(Png, RoundTripKeepsEveryByte) {
  const Image image = makeGradient(256, 200);
  const ByteImage back = std::get<ByteImage>(decodeImage(encode(image), "x"));
  ASSERT_EQ(back.width, 256);
  ASSERT_EQ(back.height, 200);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 256; ++x) {
      const std::uint8_t* p = back.pixels.data() + (static_cast<std::size_t>(y) * 256 + x) * 4;
      ASSERT_EQ(p[0], x);
      ASSERT_EQ(p[1], y);
      ASSERT_EQ(p[2], (x * 7 + y) % 256);
      ASSERT_EQ(p[3], 255);
    }
}

TEST(Png, WriterRoundsAndClamps) {
  Image image(2, 1, 3);
  image.setRgb(0, 0, {-1.0F, 2.0F, std::numeric_limits<float>::quiet_NaN()});
  image.setRgb(1, 0, {0.5F, 0.4999F / 255.0F, 0.5001F / 255.0F});
  EXPECT_EQ(decodePixels(encode(image)), (std::vector<std::uint8_t>{0, 255, 0, 255, 128, 0, 1, 255}));
}

TEST(Png, WriterSpreadsOneChannel) {
  EXPECT_EQ(decodePixels(encode(Image(1, 1, 1, 1.0F))), (std::vector<std::uint8_t>{255, 255, 255, 255}));
}

TEST(Png, WriterStoresMetadataAsText) {
  const TemporaryPath path(".png");
  writePng(path.get(), Image(2, 2, 3, 0.5F), {{"technique", "reference"}, {"scene", "Brücke"}});
  const std::vector<std::byte> bytes = readFile(path.get());
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  using namespace std::string_literals;
  EXPECT_THAT(text, HasSubstr("tEXttechnique\0reference"s));
  EXPECT_THAT(text, HasSubstr("iTXtscene\0\0\0\0\0Brücke"s));
  EXPECT_THAT(text, HasSubstr("sRGB"));
}

TEST(Png, TextsAreReadBack) {
  const std::map<std::string, std::string> metadata{
      {"scene", "builtin:ring"}, {"seed", "7"}, {"file", "k\xc3\xbchl.glb"}};
  const std::vector<std::byte> png = encodePng(Image(2, 2, 3, 0.5F), metadata);
  EXPECT_EQ(readPngTexts(png), metadata);
  // Cut anywhere, it gives what was whole.
  for (std::size_t size = 0; size < png.size(); ++size)
    for (const auto& [key, value] : readPngTexts(std::span(png).first(size)))
      EXPECT_EQ(metadata.at(key), value) << size;
}

TEST(Png, TextInLatin1BecomesUtf8AndCompressedTextIsLeftOut) {
  const auto chunk = [](std::string_view name, std::string_view data) {
    return std::string("\0\0\0", 3) + static_cast<char>(data.size()) + std::string(name) + std::string(data) + "crc!";
  };
  const std::string file = "\x89PNG\r\n\x1a\n" + chunk("tEXt", std::string_view("a\0k\xfchl", 6)) +
                           chunk("zTXt", std::string_view("z\0\0xx", 5)) +
                           chunk("iTXt", std::string_view("c\0\1\0\0\0xx", 8)) +
                           chunk("iTXt", std::string_view("u\0\0\0de\0\0\xc3\xbc", 10)) +
                           chunk("iTXt", std::string_view("s", 1)) + chunk("tEXt", std::string_view("a\0twice", 7));
  const std::map<std::string, std::string> expected{{"a", "k\xc3\xbchl"}, {"u", "\xc3\xbc"}};
  EXPECT_EQ(readPngTexts(std::as_bytes(std::span(file))), expected);
  EXPECT_TRUE(readPngTexts(std::as_bytes(std::span("GIF89a"))).empty());
}

TEST(Png, WriterNamesAFullDisk) {
  try {
    writePng("/dev/full", Image(64, 64, 3, 0.5F));
    FAIL();
  } catch (const ResourceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/dev/full: cannot write: No space left on device"));
  }
}

TEST(Png, SixteenBitsAreScaledNotCut) {
  // 0x8080 is 128.5/255 of 65535 = 128 exactly; 0x00ff is nearest to 1, where cutting would give 0.
  const auto bytes = encodeRaw(2, 1, 16, PNG_COLOR_TYPE_GRAY, {0x80, 0x80, 0x00, 0xff});
  EXPECT_EQ(decodePixels(bytes), (std::vector<std::uint8_t>{128, 128, 128, 255, 1, 1, 1, 255}));
}

TEST(Png, TransparentColourBecomesAlpha) {
  const png_color_16 transparent{.index = 0, .red = 1, .green = 2, .blue = 3, .gray = 0};
  const auto bytes = encodeRaw(2, 1, 8, PNG_COLOR_TYPE_RGB, {1, 2, 3, 4, 5, 6}, &transparent);
  EXPECT_EQ(decodePixels(bytes), (std::vector<std::uint8_t>{1, 2, 3, 0, 4, 5, 6, 255}));
}

TEST(Png, InterlacedGreyWithAlphaIsRead) {
  std::vector<std::uint8_t> rows, expected;
  for (std::uint8_t i = 0; i < 9 * 9; ++i) {
    rows.insert(rows.end(), {i, static_cast<std::uint8_t>(255 - i)});
    expected.insert(expected.end(), {i, i, i, static_cast<std::uint8_t>(255 - i)});
  }
  const auto bytes = encodeRaw(9, 9, 8, PNG_COLOR_TYPE_GRAY_ALPHA, rows, nullptr, PNG_INTERLACE_ADAM7);
  EXPECT_EQ(decodePixels(bytes), expected);
}

TEST(Png, EveryTruncationIsRefused) {
  const std::vector<std::byte> bytes = encode(makeGradient(16, 16));
  for (std::size_t size = 8; size < bytes.size(); ++size)
    EXPECT_THAT(getRefusal(std::span(bytes).first(size)), HasSubstr("damaged PNG image")) << size;
}

TEST(Png, EveryFlippedByteOfThePixelsIsRefused) {
  const std::vector<std::byte> bytes = encode(makeGradient(16, 16));
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t data = text.find("IDAT") + 4;
  const std::size_t end = text.find("IEND") - 4;
  for (std::size_t i = data; i < end; ++i) {
    std::vector<std::byte> broken = bytes;
    broken[i] ^= std::byte{0x10};
    EXPECT_THAT(getRefusal(broken), HasSubstr("damaged PNG image")) << i;
  }
}

void append(std::vector<std::byte>& target, std::span<const std::byte> bytes) {
  std::ranges::copy(bytes, std::back_inserter(target));
}

/// Length, name and data (given), check sum.
std::vector<std::byte> makeChunk(std::span<const std::byte> name_and_data) {
  const auto* data = reinterpret_cast<const Bytef*>(name_and_data.data());
  const auto check_sum = static_cast<std::uint32_t>(crc32(0, data, static_cast<uInt>(name_and_data.size())));
  const auto length = static_cast<std::uint32_t>(name_and_data.size() - 4);
  std::vector<std::byte> chunk;
  for (unsigned shift = 32; shift > 0;) chunk.push_back(static_cast<std::byte>(length >> (shift -= 8U)));
  append(chunk, name_and_data);
  for (unsigned shift = 32; shift > 0;) chunk.push_back(static_cast<std::byte>(check_sum >> (shift -= 8U)));
  return chunk;
}

/// Splits the one IDAT chunk of a file so that the check sum of the pixels (its last four bytes) is alone in a second.
std::vector<std::byte> splitCheckSum(std::span<const std::byte> bytes, std::byte flip) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t name = text.find("IDAT"), data_end = text.find("IEND") - 8;
  std::vector<std::byte> second = makeBytes("IDAT");
  append(second, bytes.subspan(data_end - 4, 4));
  second.back() ^= flip;
  std::vector<std::byte> result;
  append(result, bytes.first(name - 4));
  append(result, makeChunk(bytes.subspan(name, data_end - 4 - name)));
  append(result, makeChunk(second));
  append(result, bytes.subspan(data_end + 4));
  return result;
}

TEST(Png, WrongCheckSumBehindTheLastPixelIsRefused) {
  // There libpng only warns: it has all the pixels already.
  const std::vector<std::byte> bytes = encodeRaw(64, 64, 8, PNG_COLOR_TYPE_GRAY, std::vector<std::uint8_t>(64 * 64, 7));
  EXPECT_EQ(decodePixels(splitCheckSum(bytes, std::byte{0})), decodePixels(bytes));
  EXPECT_THAT(getRefusal(splitCheckSum(bytes, std::byte{1})),
              HasSubstr("damaged PNG image: IDAT: incorrect data check"));
}

TEST(Png, HugeSizeInASmallFileIsRefusedAtOnce) {
  std::vector<std::byte> bytes = encode(makeGradient(4, 4));
  // 16384 x 16384 is allowed, but not from a hundred bytes. (The check sum of the header follows its 13 bytes.)
  bytes[16 + 2] = std::byte{0x40}, bytes[16 + 3] = std::byte{0};
  bytes[20 + 2] = std::byte{0x40}, bytes[20 + 3] = std::byte{0};
  const std::vector<std::byte> header = makeChunk(std::span(bytes).subspan(12, 4 + 13));
  std::ranges::copy(header, bytes.begin() + 8);
  EXPECT_THAT(getRefusal(bytes), HasSubstr("the file ends too early for its width and height"));
}

}  // namespace
}  // namespace nephroid
