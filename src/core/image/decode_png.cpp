// PNG through libpng's low-level interface: its simplified one would apply gamma and read 16 bits as linear light.
//
// libpng reports errors by longjmp. It is confined to the two functions that call setjmp: they hold nothing with a
// destructor, and what they write they reach through a pointer, so no value is lost in the jump.

#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "core/image/decoders.h"

namespace nephroid {
namespace {

struct PngState {
  std::span<const std::byte> bytes;
  std::size_t position = 0;
  char error[160] = {};   ///< set before every jump
  char damage[160] = {};  ///< a warning that means wrong pixels
  std::uint32_t width = 0, height = 0;
  std::size_t row_bytes = 0;
  std::uint64_t file_row_bits = 0;
};

void setMessage(char (&target)[160], const char* message) { std::snprintf(target, sizeof target, "%s", message); }

[[noreturn]] void onPngError(png_structp png, png_const_charp message) {
  auto* state = static_cast<PngState*>(png_get_error_ptr(png));
  setMessage(state->error, message);
  png_longjmp(png, 1);
}

/// Most warnings are about chunks that we do not use. Those of IDAT are about pixels: a compressed stream whose check
/// sum or end is wrong. More data than the picture needs is harmless, though.
void onPngWarning(png_structp png, png_const_charp message) {
  const std::string_view text(message);
  const bool is_harmless = text.find("Extra compressed data") != std::string_view::npos ||
                           text.find("Too much image data") != std::string_view::npos;
  if (text.starts_with("IDAT:") && !is_harmless)
    setMessage(static_cast<PngState*>(png_get_error_ptr(png))->damage, message);
}

void readPngBytes(png_structp png, png_bytep target, std::size_t size) {
  auto* state = static_cast<PngState*>(png_get_io_ptr(png));
  if (size > state->bytes.size() - state->position) png_error(png, "the file ends too early");
  std::memcpy(target, state->bytes.data() + state->position, size);
  state->position += size;
}

/// Reads up to the pixels and asks for 8-bit RGBA. @return false with `state->error` set
bool readPngHeader(png_structp png, png_infop info, PngState* state) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, state, readPngBytes);
  png_read_info(png, info);
  state->width = png_get_image_width(png, info);
  state->height = png_get_image_height(png, info);
  state->file_row_bits =
      std::uint64_t{state->width} * png_get_bit_depth(png, info) * std::uint64_t{png_get_channels(png, info)};
  png_set_expand(png);
  png_set_scale_16(png);
  png_set_gray_to_rgb(png);
  const bool has_alpha =
      (png_get_color_type(png, info) & PNG_COLOR_MASK_ALPHA) != 0 || png_get_valid(png, info, PNG_INFO_tRNS) != 0;
  if (!has_alpha) png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  state->row_bytes = png_get_rowbytes(png, info);
  return true;
}

/// @return false with `state->error` set
bool readPngRows(png_structp png, png_infop info, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_image(png, rows);
  png_read_end(png, info);
  return true;
}

struct PngReader {
  explicit PngReader(PngState* state)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, state, onPngError, onPngWarning)) {
    if (png == nullptr) throw std::bad_alloc();
    info = png_create_info_struct(png);
    if (info == nullptr) {
      png_destroy_read_struct(&png, nullptr, nullptr);
      throw std::bad_alloc();
    }
    // Compressed text and profiles could each unpack to gigabytes; real ones are far smaller.
    png_set_chunk_malloc_max(png, 8U << 20);
    png_set_chunk_cache_max(png, 128);
    png_set_user_limits(png, static_cast<png_uint_32>(kMaxEdge), static_cast<png_uint_32>(kMaxEdge));
    // Faults that libpng can go on from become warnings, of which onPngWarning picks those that matter.
    png_set_benign_errors(png, 1);
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }

  png_structp png = nullptr;
  png_infop info = nullptr;
};

/// libpng takes memory for a whole chunk before it reads it, up to 2 GiB: so the chunks must fit into the file.
void checkPngChunks(std::span<const std::byte> bytes, const std::string& label) {
  constexpr std::size_t kSignatureSize = 8;
  constexpr std::size_t kChunkFrame = 12;  // length, name, check sum
  for (std::size_t at = kSignatureSize; at + kChunkFrame <= bytes.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8 | std::to_integer<std::size_t>(bytes[at + i]);
    const std::string_view name(reinterpret_cast<const char*>(bytes.data()) + at + 4, 4);
    if (length > bytes.size() - at - kChunkFrame) failDamagedImage(label, "PNG", "the file ends too early");
    if (name == "IEND") return;
    at += kChunkFrame + length;
  }
}

/// Refuses, before any memory is taken, a file too short for its size: deflate yields at most 1032 bytes per byte.
void checkPngLength(const PngState& state, const std::string& label) {
  constexpr std::uint64_t kMaxDeflateRatio = 1032;
  if (state.file_row_bits * state.height / 8 > kMaxDeflateRatio * state.bytes.size())
    failDamagedImage(label, "PNG", "the file ends too early for its width and height");
}

}  // namespace

ByteImage decodePng(std::span<const std::byte> bytes, const std::string& label) {
  checkPngChunks(bytes, label);
  PngState state{.bytes = bytes};
  const PngReader reader(&state);
  if (!readPngHeader(reader.png, reader.info, &state)) failDamagedImage(label, "PNG", state.error);
  checkImageSize(state.width, state.height, label);
  checkPngLength(state, label);
  if (state.row_bytes != std::size_t{state.width} * 4) failDamagedImage(label, "PNG", "unexpected row length");

  ByteImage image{.width = static_cast<int>(state.width), .height = static_cast<int>(state.height), .pixels = {}};
  image.pixels.resize(state.row_bytes * state.height);
  std::vector<png_bytep> rows(state.height);
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = image.pixels.data() + y * state.row_bytes;
  if (!readPngRows(reader.png, reader.info, rows.data())) failDamagedImage(label, "PNG", state.error);
  if (state.damage[0] != '\0') failDamagedImage(label, "PNG", state.damage);
  return image;
}

}  // namespace nephroid
