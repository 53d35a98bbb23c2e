// WebP through libwebp, which needs no more care than its status codes.

#include <webp/decode.h>

#include "core/image/decoders.h"

namespace nephroid {
namespace {

std::string_view describeStatus(VP8StatusCode status) {
  switch (status) {
    case VP8_STATUS_OUT_OF_MEMORY:
      return "out of memory";
    case VP8_STATUS_BITSTREAM_ERROR:
      return "the compressed data are wrong";
    case VP8_STATUS_UNSUPPORTED_FEATURE:
      return "it uses a feature that libwebp does not support";
    case VP8_STATUS_SUSPENDED:
    case VP8_STATUS_NOT_ENOUGH_DATA:
      return "the file ends too early";
    default:
      return "libwebp refuses it";
  }
}

void checkStatus(VP8StatusCode status, const std::string& label) {
  if (status == VP8_STATUS_OUT_OF_MEMORY) throw std::bad_alloc();
  if (status != VP8_STATUS_OK) failDamagedImage(label, "WebP", describeStatus(status));
}

}  // namespace

ByteImage decodeWebp(std::span<const std::byte> bytes, const std::string& label) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  WebPDecoderConfig config;
  if (WebPInitDecoderConfig(&config) == 0) throw InternalError("libwebp is of another version than its headers");
  checkStatus(WebPGetFeatures(data, bytes.size(), &config.input), label);
  if (config.input.has_animation != 0)
    throw InputError(label + ": animated WebP is not supported; export one frame of it");
  checkImageSize(config.input.width, config.input.height, label);

  ByteImage image{.width = config.input.width, .height = config.input.height, .pixels = {}};
  image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4);
  config.output.colorspace = MODE_RGBA;
  config.output.is_external_memory = 1;
  config.output.u.RGBA = {.rgba = image.pixels.data(), .stride = image.width * 4, .size = image.pixels.size()};
  checkStatus(WebPDecode(data, bytes.size(), &config), label);
  return image;
}

}  // namespace nephroid
