// One function per file format, for image_io.cpp alone. All take hostile input: a message or a whole picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <string>
#include <string_view>

#include "core/image/image.h"
#include "nephroid/error.h"

namespace nephroid {

/// The longest edge of an image that is read; JPEG ends there, too.
inline constexpr std::int64_t kMaxEdge = 65536;

/// @throws InputError unless both edges are in [1, kMaxEdge] and the area is within kMaxPixels
void checkImageSize(std::int64_t width, std::int64_t height, const std::string& label);

/// @throws InputError "LABEL: damaged FORMAT image: WHAT; …"
[[noreturn]] void failDamagedImage(const std::string& label, std::string_view format, std::string_view what);

/// @throws ResourceError
[[noreturn]] void failImageMemory(const std::string& label, std::int64_t width, std::int64_t height);

/// 8 bits per channel; 16 bits are scaled, palettes and grey expanded, tRNS made alpha; no gamma is applied.
ByteImage decodePng(std::span<const std::byte> bytes, const std::string& label);
/// Grey or YCbCr, sequential or progressive; CMYK is refused by name.
ByteImage decodeJpeg(std::span<const std::byte> bytes, const std::string& label);
/// Lossy or lossless stills; animations are refused by name.
ByteImage decodeWebp(std::span<const std::byte> bytes, const std::string& label);
/// Radiance RGBE, flat or in either run-length coding; radiance is divided by the header's EXPOSURE values.
Image decodeHdr(std::span<const std::byte> bytes, const std::string& label);
/// As `decodeImage` says; values as stored, not yet made finite.
Image decodeExr(std::span<const std::byte> bytes, const std::string& label);

}  // namespace nephroid
