#include "core/image/image_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/file.h"
#include "core/image/decoders.h"
#include "core/image/tonemap.h"

namespace nephroid {
namespace {

enum class FileFormat { kPng, kJpeg, kWebp, kExr, kHdr, kUnsupported, kUnknown };

struct Signature {
  std::string_view bytes;
  FileFormat format;
  std::string_view name;
};

using namespace std::string_view_literals;

/// How each format begins; those that we refuse are here so that they are refused by name.
constexpr std::array kSignatures{
    Signature{"\x89PNG\r\n\x1a\n"sv, FileFormat::kPng, "PNG"},
    Signature{"\xff\xd8\xff"sv, FileFormat::kJpeg, "JPEG"},
    Signature{"\x76\x2f\x31\x01"sv, FileFormat::kExr, "OpenEXR"},
    Signature{"#?RADIANCE"sv, FileFormat::kHdr, "Radiance HDR"},
    Signature{"#?RGBE"sv, FileFormat::kHdr, "Radiance HDR"},
    Signature{"\xabKTX 20\xbb\r\n\x1a\n"sv, FileFormat::kUnsupported, "KTX2"},
    Signature{"\xabKTX 11\xbb\r\n\x1a\n"sv, FileFormat::kUnsupported, "KTX"},
    Signature{"DDS "sv, FileFormat::kUnsupported, "DDS"},
    Signature{"GIF8"sv, FileFormat::kUnsupported, "GIF"},
    Signature{"II*\0"sv, FileFormat::kUnsupported, "TIFF"},
    Signature{"MM\0*"sv, FileFormat::kUnsupported, "TIFF"},
    Signature{"BM"sv, FileFormat::kUnsupported, "BMP"},
};

Signature identify(std::span<const std::byte> bytes) {
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 32));
  for (const Signature& signature : kSignatures)
    if (head.starts_with(signature.bytes)) return signature;
  if (head.starts_with("RIFF") && head.size() >= 12 && head.substr(8, 4) == "WEBP")
    return {"RIFF", FileFormat::kWebp, "WebP"};
  return {"", FileFormat::kUnknown, "unknown"};
}

/// NaN and −∞ become 0, +∞ the largest half.
Image makeFinite(Image image) {
  constexpr float kLargestHalf = 65504.0F;
  for (float& value : image.pixels)
    if (!std::isfinite(value)) value = value > 0.0F ? kLargestHalf : 0.0F;
  return image;
}

Image toLinear(const ByteImage& image, bool srgb) {
  std::array<float, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const float coded = static_cast<float>(i) / 255.0F;
    linear[i] = srgb ? linearFromSrgb(coded) : coded;
  }
  Image result(image.width, image.height, 3);
  const std::size_t pixel_count = image.pixels.size() / 4;
  for (std::size_t i = 0; i < pixel_count; ++i)
    for (std::size_t c = 0; c < 3; ++c) result.pixels[3 * i + c] = linear[image.pixels[4 * i + c]];
  return result;
}

Image dropAlpha(const Image& image) {
  Image result(image.width, image.height, 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) result.setRgb(x, y, image.rgb(x, y));
  return result;
}

}  // namespace

void checkImageSize(std::int64_t width, std::int64_t height, const std::string& label) {
  if (width < 1 || height < 1)
    throw InputError(
        fmt::format("{}: image of {} x {} pixels; expected at least 1 x 1; the file is damaged", label, width, height));
  if (width > kMaxEdge || height > kMaxEdge || static_cast<std::uint64_t>(width * height) > kMaxPixels)
    throw InputError(
        fmt::format("{}: image of {} x {} pixels; at most {} pixels and edges up to {} are accepted; "
                    "scale it down",
                    label, width, height, kMaxPixels, kMaxEdge));
}

void failDamagedImage(const std::string& label, std::string_view format, std::string_view what) {
  std::string line(what);
  // Libraries' own words may hold line breaks; our messages are one line.
  std::ranges::replace_if(
      line, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  if (line.ends_with('.')) line.pop_back();
  throw InputError(fmt::format("{}: damaged {} image: {}; fetch or export the file again", label, format, line));
}

void failImageMemory(const std::string& label, std::int64_t width, std::int64_t height) {
  throw ResourceError(
      fmt::format("{}: not enough memory for an image of {} x {} pixels; scale it down", label, width, height));
}

DecodedImage decodeImage(std::span<const std::byte> bytes, const std::string& label) {
  const Signature signature = identify(bytes);
  try {
    switch (signature.format) {
      case FileFormat::kPng:
        return decodePng(bytes, label);
      case FileFormat::kJpeg:
        return decodeJpeg(bytes, label);
      case FileFormat::kWebp:
        return decodeWebp(bytes, label);
      case FileFormat::kExr:
        return makeFinite(decodeExr(bytes, label));
      case FileFormat::kHdr:
        return makeFinite(decodeHdr(bytes, label));
      case FileFormat::kUnsupported:
        throw InputError(fmt::format("{}: {} images are not supported; convert it to PNG, JPEG, WebP, EXR or HDR",
                                     label, signature.name));
      case FileFormat::kUnknown:
        break;
    }
  } catch (const std::bad_alloc&) {
    throw ResourceError(
        fmt::format("{}: not enough memory to decode this {} image; scale it down", label, signature.name));
  }
  throw InputError(
      fmt::format("{}: not an image that Nephroid knows ({} bytes, no known signature); expected PNG, "
                  "JPEG, WebP, EXR or Radiance HDR",
                  label, bytes.size()));
}

DecodedImage loadImage(const std::filesystem::path& path) { return decodeImage(readFile(path), path.string()); }

Image toLinear(const DecodedImage& image, bool srgb) {
  if (const ByteImage* coded = std::get_if<ByteImage>(&image)) return toLinear(*coded, srgb);
  const Image& linear = std::get<Image>(image);
  return linear.channels == 3 ? linear : dropAlpha(linear);
}

}  // namespace nephroid
