// Image files in and out. Readers treat their input as hostile; writers are atomic.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>

#include "core/image/image.h"

namespace nephroid {

/// Images above this many pixels are refused: 16 384², as large as textures get.
inline constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 28;

/// Decodes PNG, JPEG, WebP, EXR or Radiance HDR, recognised by content, never by name.
///
/// EXR: scan lines and tiles (level 0), any compression that OpenEXR reads, R,G,B(,A) or Y; display window ignored,
/// data window read; luminance-chroma (Y, RY, BY) converted; deep images refused. NaN and negative infinity become 0,
/// positive infinity the largest half (65 504), so that one bad texel cannot poison an environment.
/// @param label  how messages name the input (a path, or "image 3 of scene.glb")
/// @throws InputError
DecodedImage decodeImage(std::span<const std::byte> bytes, const std::string& label);

/// `decodeImage` of a file.
DecodedImage loadImage(const std::filesystem::path& path);

/// As linear RGB float; 8-bit input is decoded from sRGB when `srgb`, else scaled by 1/255.
Image toLinear(const DecodedImage& image, bool srgb = true);

/// Every layer of a multi-layer EXR, as `writeExr` stores them: `R,G,B` becomes layer "beauty", `caustic.R` … layer
/// "caustic", `depth.Z`, `id.I` and other single channels one-channel layers. Metadata: all string attributes.
/// @throws InputError
LayeredImage readExr(const std::filesystem::path& path);

/// @param half  16-bit floats instead of 32-bit
/// `beauty` in `R,G,B`, layer L in `L.R, L.G, L.B`, one-channel layers in `depth.Z`, `id.I`; ZIP; metadata as string
/// attributes. Atomic.
/// @throws ResourceError
void writeExr(const std::filesystem::path& path, const LayeredImage& image, bool half = false);

/// What a PNG says of itself: keyword and text of its chunks tEXt and iTXt, as UTF-8, the first of each keyword.
/// Compressed text is left out, and all that follows damage. Never more than the file's own size.
/// @return nothing for any other format
std::map<std::string, std::string> readPngTexts(std::span<const std::byte> bytes);

/// 8-bit RGB PNG of display-referred values in [0, 1] that are already sRGB-coded. Metadata as tEXt chunks.
/// @throws ResourceError
std::vector<std::byte> encodePng(const Image& display, const std::map<std::string, std::string>& metadata = {});
/// The same as a file. Atomic.
/// @throws ResourceError
void writePng(const std::filesystem::path& path, const Image& display,
              const std::map<std::string, std::string>& metadata = {});

}  // namespace nephroid
