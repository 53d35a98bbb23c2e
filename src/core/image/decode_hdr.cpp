// Radiance RGBE (.hdr) through stb_image, behind a walk over the data that stb_image needs.
//
// stb_image reads zeros beyond the end of its input: a file cut off gives black rows or, in some versions, an endless
// loop (a run of length 0). It also takes the old run-length coding for flat pixels. So the scan lines are walked
// first; what passes is complete, and old runs are written out as flat pixels. See G. Ward, "Real Pixels", Graphics
// Gems II (1991), and the format's description in Radiance's reference manual, "File Formats".

#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

// In the translation unit alone, so that another copy in the program cannot collide with this one.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 65536
#include <stb_image.h>

#include "core/image/decoders.h"

namespace nephroid {
namespace {

using Bytes = std::span<const std::uint8_t>;

[[noreturn]] void failHdr(const std::string& label, std::string_view what) {
  failDamagedImage(label, "Radiance HDR", what);
}

struct HdrHeader {
  int width = 0, height = 0;
  std::size_t data_begin = 0;  ///< offset of the first scan line
  double exposure = 1.0;       ///< what all pixels have been multiplied by
};

/// The product of the EXPOSURE= lines: the format says that they accumulate.
double parseExposure(std::string_view header, const std::string& label) {
  constexpr std::string_view kKey = "\nEXPOSURE=";
  double exposure = 1.0;
  for (std::size_t at = header.find(kKey); at != std::string_view::npos; at = header.find(kKey, at + 1)) {
    std::string_view text = header.substr(at + kKey.size());
    text = text.substr(0, text.find_first_of("\r\n"));
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    double factor = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), factor);
    if (error != std::errc() || !(factor > 0.0) || !std::isfinite(factor))
      failHdr(label, "EXPOSURE is not a positive number");
    exposure *= factor;
  }
  if (!(exposure > 0.0) || !std::isfinite(exposure)) failHdr(label, "EXPOSURE is out of range");
  return exposure;
}

HdrHeader readHeader(Bytes bytes, const std::string& label) {
  HdrHeader header;
  int channels = 0;
  if (stbi_info_from_memory(bytes.data(), static_cast<int>(bytes.size()), &header.width, &header.height, &channels) ==
      0)
    failHdr(label, fmt::format("the header is not one of 32-bit_rle_rgbe with -Y rows +X columns ({})",
                               stbi_failure_reason()));
  checkImageSize(header.width, header.height, label);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t blank = text.find("\n\n");
  const std::size_t end = blank == std::string_view::npos ? blank : text.find('\n', blank + 2);
  if (end == std::string_view::npos) failHdr(label, "the header has no end");
  header.data_begin = end + 1;
  header.exposure = parseExposure(text.substr(0, blank), label);
  return header;
}

/// Whether scan lines of this width may be, and these bytes are, in the newer coding: 2, 2 and the width.
bool beginsNewRuns(Bytes data, int width) {
  return width >= 8 && width < 32768 && data.size() >= 4 && data[0] == 2 && data[1] == 2 && (data[2] & 0x80) == 0;
}

/// Takes one scan line of four run-length coded planes off the front of `data`.
Bytes skipNewRuns(Bytes data, int width, const std::string& label) {
  if (!beginsNewRuns(data, width) || (data[2] << 8 | data[3]) != width)
    failHdr(label, "a scan line does not begin as it should, or the file ends too early");
  data = data.subspan(4);
  for (int plane = 0; plane < 4; ++plane) {
    for (int x = 0; x < width;) {
      if (data.empty()) failHdr(label, "the file ends too early");
      const int code = data[0];
      const int run = code > 128 ? code - 128 : code;
      const std::size_t coded_size = code > 128 ? 2 : 1 + static_cast<std::size_t>(run);
      if (run == 0 || run > width - x) failHdr(label, "a run does not fit its scan line");
      if (coded_size > data.size()) failHdr(label, "the file ends too early");
      data = data.subspan(coded_size);
      x += run;
    }
  }
  return data;
}

/// Writes flat pixels or the older coding, where the pixel 1, 1, 1, n repeats the one before n times (n << 8, n << 16
/// … if such pixels follow each other), as flat pixels behind `target`.
void expandOldRuns(Bytes data, std::size_t pixel_count, std::vector<std::uint8_t>& target, const std::string& label) {
  const std::size_t begin = target.size();
  const std::size_t end = begin + 4 * pixel_count;
  int shift = 0;
  while (target.size() < end) {
    if (data.size() < 4) failHdr(label, "the file ends too early");
    const std::array<std::uint8_t, 4> pixel{data[0], data[1], data[2], data[3]};
    data = data.subspan(4);
    if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
      target.insert(target.end(), pixel.begin(), pixel.end());
      shift = 0;
      continue;
    }
    const std::size_t run = shift < 32 ? std::size_t{pixel[3]} << shift : pixel_count + 1;
    if (target.size() == begin || 4 * run > end - target.size()) failHdr(label, "a run does not fit the picture");
    std::array<std::uint8_t, 4> last{};
    std::copy(target.end() - 4, target.end(), last.begin());
    for (std::size_t i = 0; i < run; ++i) target.insert(target.end(), last.begin(), last.end());
    shift += 8;
  }
}

/// The file with its scan lines flat, or nothing if stb_image can take it as it is.
std::optional<std::vector<std::uint8_t>> checkScanLines(Bytes bytes, const HdrHeader& header,
                                                        const std::string& label) {
  Bytes data = bytes.subspan(header.data_begin);
  if (beginsNewRuns(data, header.width)) {
    for (int y = 0; y < header.height; ++y) data = skipNewRuns(data, header.width, label);
    return std::nullopt;
  }
  std::vector<std::uint8_t> flat(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(header.data_begin));
  const auto pixel_count = static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height);
  expandOldRuns(data, pixel_count, flat, label);
  return flat;
}

}  // namespace

Image decodeHdr(std::span<const std::byte> bytes, const std::string& label) {
  const Bytes file(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  if (file.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw InputError(label + ": Radiance HDR files above 2 GiB are not supported; convert it to EXR");
  const HdrHeader header = readHeader(file, label);
  const std::optional<std::vector<std::uint8_t>> flat = checkScanLines(file, header, label);
  const Bytes checked = flat ? Bytes(*flat) : file;
  if (checked.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    failImageMemory(label, header.width, header.height);

  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<float, decltype(&stbi_image_free)> pixels(
      stbi_loadf_from_memory(checked.data(), static_cast<int>(checked.size()), &width, &height, &channels, 3),
      stbi_image_free);
  if (pixels == nullptr) failHdr(label, stbi_failure_reason());
  Image image(width, height, 3);
  const auto scale = static_cast<float>(1.0 / header.exposure);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = pixels.get()[i] * scale;
  return image;
}

}  // namespace nephroid
