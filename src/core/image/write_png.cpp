// 8-bit sRGB PNG through libpng, built in memory. As in decode_png.cpp, longjmp is confined to one function that owns
// nothing.

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <new>
#include <vector>

#include "core/file.h"
#include "core/image/image_io.h"
#include "nephroid/error.h"

namespace nephroid {
namespace {

struct PngSink {
  std::vector<std::byte> bytes;
  bool out_of_memory = false;
  char error[160] = {};
};

[[noreturn]] void onPngError(png_structp png, png_const_charp message) {
  auto* sink = static_cast<PngSink*>(png_get_error_ptr(png));
  std::snprintf(sink->error, sizeof sink->error, "%s", message);
  png_longjmp(png, 1);
}

void onPngWarning(png_structp, png_const_charp) {}

/// Exceptions must not pass through libpng, which is C: hence the flag.
bool appendBytes(PngSink* sink, png_const_bytep source, std::size_t size) noexcept {
  try {
    const auto* begin = reinterpret_cast<const std::byte*>(source);
    sink->bytes.insert(sink->bytes.end(), begin, begin + size);
    return true;
  } catch (const std::bad_alloc&) {
    sink->out_of_memory = true;
    return false;
  }
}

void writePngBytes(png_structp png, png_bytep source, std::size_t size) {
  if (!appendBytes(static_cast<PngSink*>(png_get_io_ptr(png)), source, size)) png_error(png, "out of memory");
}

void flushPng(png_structp) {}

struct PngWriter {
  explicit PngWriter(PngSink* sink)
      : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, sink, onPngError, onPngWarning)) {
    if (png == nullptr) throw std::bad_alloc();
    info = png_create_info_struct(png);
    if (info == nullptr) {
      png_destroy_write_struct(&png, nullptr);
      throw std::bad_alloc();
    }
  }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png, &info); }

  png_structp png = nullptr;
  png_infop info = nullptr;
};

/// What the C-like writer needs, prepared outside it.
struct PngContent {
  png_uint_32 width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
  std::vector<png_bytep> rows;
  std::vector<std::string> keywords;
  std::vector<png_text> texts;
};

/// @return false with `sink->error` set
bool writePngStream(png_structp png, png_infop info, PngSink* sink, PngContent* content) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, sink, writePngBytes, flushPng);
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_set_IHDR(png, info, content->width, content->height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_RELATIVE);
  png_set_text(png, info, content->texts.data(), static_cast<int>(content->texts.size()));
  png_write_info(png, info);
  png_write_image(png, content->rows.data());
  png_write_end(png, info);
  return true;
}

/// To the nearest of 256 steps; NaN becomes 0.
std::uint8_t quantise(float value) {
  return value > 0.0F ? static_cast<std::uint8_t>(std::lround(std::min(value, 1.0F) * 255.0F)) : std::uint8_t{0};
}

bool isAscii(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

/// Plain text as tEXt; text beyond ASCII as iTXt, which is UTF-8 where tEXt would be Latin-1.
void addTexts(PngContent& content, const std::map<std::string, std::string>& metadata) {
  constexpr std::size_t kMaxKeyword = 79;  // of the PNG specification
  content.keywords.reserve(metadata.size());
  for (const auto& [key, value] : metadata) {
    png_text text{};
    text.compression = isAscii(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    text.key = content.keywords.emplace_back(key.substr(0, kMaxKeyword)).data();
    text.text = const_cast<char*>(value.c_str());  // libpng's type; it copies
    text.text_length = value.size();
    content.texts.push_back(text);
  }
}

PngContent prepareContent(const Image& display, const std::map<std::string, std::string>& metadata) {
  PngContent content;
  content.width = static_cast<png_uint_32>(display.width);
  content.height = static_cast<png_uint_32>(display.height);
  const std::size_t row_bytes = static_cast<std::size_t>(display.width) * 3;
  content.pixels.resize(row_bytes * static_cast<std::size_t>(display.height));
  for (int y = 0; y < display.height; ++y) {
    std::uint8_t* row = content.pixels.data() + static_cast<std::size_t>(y) * row_bytes;
    content.rows.push_back(row);
    for (int x = 0; x < display.width; ++x) {
      const vec3 rgb = display.rgb(x, y);
      for (int c = 0; c < 3; ++c) *row++ = quantise(rgb[c]);
    }
  }
  addTexts(content, metadata);
  return content;
}

}  // namespace

std::vector<std::byte> encodePng(const Image& display, const std::map<std::string, std::string>& metadata) {
  PngSink sink;
  try {
    PngContent content = prepareContent(display, metadata);
    const PngWriter writer(&sink);
    if (!writePngStream(writer.png, writer.info, &sink, &content) && !sink.out_of_memory)
      throw InternalError(
          fmt::format("libpng refuses to encode {} x {} pixels: {}", display.width, display.height, sink.error));
  } catch (const std::bad_alloc&) {
    sink.out_of_memory = true;
  }
  if (sink.out_of_memory)
    throw ResourceError(fmt::format("not enough memory to encode {} x {} pixels as PNG; ask for a smaller picture",
                                    display.width, display.height));
  return std::move(sink.bytes);
}

void writePng(const std::filesystem::path& path, const Image& display,
              const std::map<std::string, std::string>& metadata) {
  std::vector<std::byte> bytes;
  try {
    bytes = encodePng(display, metadata);
  } catch (const ResourceError& error) {
    throw ResourceError(fmt::format("{}: {}", path.string(), error.what()));
  }
  writeFileAtomically(path, bytes);
}

}  // namespace nephroid
