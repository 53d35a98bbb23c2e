// JPEG through libjpeg-turbo. As with libpng, longjmp is confined to two functions that own nothing.

// jpeglib.h needs FILE and size_t declared before it.
#include <cstddef>
#include <cstdio>

#include <jpeglib.h>

#include <jerror.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>

#include "core/image/decoders.h"

namespace nephroid {
namespace {

/// libjpeg hands back a pointer to `base`, which is therefore the first member.
struct JpegErrors {
  jpeg_error_mgr base;
  std::jmp_buf jump;
  char message[JMSG_LENGTH_MAX];
};

[[noreturn]] void onJpegError(j_common_ptr common) {
  auto* errors = reinterpret_cast<JpegErrors*>(common->err);
  common->err->format_message(common, errors->message);
  std::longjmp(errors->jump, 1);
}

/// libjpeg goes on after damage and fills the rest with grey; we do not. Warnings that are not about pixels pass.
void onJpegMessage(j_common_ptr common, int level) {
  constexpr std::array kHarmless{JWRN_ADOBE_XFORM, JWRN_EXTRANEOUS_DATA, JWRN_JFIF_MAJOR, JWRN_TOO_MUCH_DATA};
  if (level < 0 && std::ranges::find(kHarmless, common->err->msg_code) == kHarmless.end()) onJpegError(common);
}

/// A progressive file may repeat scans without end, each of which costs a pass over the whole picture.
void onJpegProgress(j_common_ptr common) {
  constexpr int kMaxScans = 500;  // ten times what encoders write
  auto* jpeg = reinterpret_cast<j_decompress_ptr>(common);
  if (jpeg->input_scan_number <= kMaxScans) return;
  auto* errors = reinterpret_cast<JpegErrors*>(common->err);
  std::snprintf(errors->message, sizeof errors->message, "more than %d scans", kMaxScans);
  std::longjmp(errors->jump, 1);
}

/// Owns libjpeg's state; `destroy` is a no-op on a struct that was never created.
struct JpegReader {
  JpegReader() {
    jpeg.err = jpeg_std_error(&errors.base);
    errors.base.error_exit = onJpegError;
    errors.base.emit_message = onJpegMessage;
    progress.progress_monitor = onJpegProgress;
  }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
  ~JpegReader() { jpeg_destroy_decompress(&jpeg); }

  jpeg_decompress_struct jpeg{};
  JpegErrors errors{};
  jpeg_progress_mgr progress{};
};

/// @return false with the message set
bool readJpegHeader(JpegReader* reader, const unsigned char* bytes, unsigned long size) {
  if (setjmp(reader->errors.jump) != 0) return false;
  jpeg_create_decompress(&reader->jpeg);
  reader->jpeg.progress = &reader->progress;
  jpeg_mem_src(&reader->jpeg, bytes, size);
  jpeg_read_header(&reader->jpeg, TRUE);
  return true;
}

/// @return false with the message set
bool readJpegRows(JpegReader* reader, unsigned char* pixels) {
  if (setjmp(reader->errors.jump) != 0) return false;
  jpeg_decompress_struct* jpeg = &reader->jpeg;
  jpeg->out_color_space = JCS_EXT_RGBA;  // libjpeg-turbo's own, alpha 255
  jpeg_start_decompress(jpeg);
  while (jpeg->output_scanline < jpeg->output_height) {
    JSAMPROW row = pixels + std::size_t{jpeg->output_scanline} * jpeg->output_width * 4;
    jpeg_read_scanlines(jpeg, &row, 1);
  }
  jpeg_finish_decompress(jpeg);
  return true;
}

/// Each 8 × 8 block of the largest component costs at least one bit under Huffman coding; arithmetic coding may go
/// below, and is left to the limit on pixels.
void checkJpegLength(const jpeg_decompress_struct& jpeg, std::size_t byte_count, const std::string& label) {
  const std::uint64_t blocks = std::uint64_t{jpeg.image_width} * jpeg.image_height / 64;
  if (jpeg.arith_code == FALSE && blocks > 8 * std::uint64_t{byte_count})
    failDamagedImage(label, "JPEG", "the file ends too early for its width and height");
}

}  // namespace

ByteImage decodeJpeg(std::span<const std::byte> bytes, const std::string& label) {
  JpegReader reader;
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  if (!readJpegHeader(&reader, data, static_cast<unsigned long>(bytes.size())))
    failDamagedImage(label, "JPEG", reader.errors.message);
  checkImageSize(reader.jpeg.image_width, reader.jpeg.image_height, label);
  checkJpegLength(reader.jpeg, bytes.size(), label);
  if (reader.jpeg.jpeg_color_space == JCS_CMYK || reader.jpeg.jpeg_color_space == JCS_YCCK)
    throw InputError(label + ": JPEG in CMYK (printing inks) is not supported; convert it to RGB");

  ByteImage image{.width = static_cast<int>(reader.jpeg.image_width),
                  .height = static_cast<int>(reader.jpeg.image_height),
                  .pixels = {}};
  image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4);
  if (!readJpegRows(&reader, image.pixels.data())) failDamagedImage(label, "JPEG", reader.errors.message);
  return image;
}

}  // namespace nephroid
