// EXR as a texture or an environment: RGB or RGBA of the first part that has colour.

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/image/exr_file.h"

namespace nephroid {
namespace {

bool hasColour(const Imf::Header& header) { return hasChannels(header, {"R", "G", "B"}) || hasChannels(header, {"Y"}); }

/// @throws InputError if no part has R,G,B or Y
int findColourPart(const ExrFile& file, const std::string& label) {
  for (int part = 0; part < file.partCount(); ++part)
    if (!file.isDeep(part) && hasColour(file.header(part))) return part;
  file.checkPart(0);  // a deep image is named as such
  throw InputError(
      fmt::format("{}: OpenEXR image without colour: found channels {}; expected R, G, B or Y; rename or "
                  "extract the channels that you mean",
                  label, listChannels(file.header(0))));
}

/// Grey (and alpha) spread over RGB(A).
Image spreadGrey(const Image& grey) {
  const bool has_alpha = grey.channels == 2;
  Image image(grey.width, grey.height, has_alpha ? 4 : 3);
  for (int y = 0; y < grey.height; ++y)
    for (int x = 0; x < grey.width; ++x) {
      const float* source = grey.at(x, y);
      image.setRgb(x, y, vec3(source[0]));
      if (has_alpha) image.at(x, y)[3] = source[1];
    }
  return image;
}

Image readColour(const ExrFile& file, int part) {
  const Imf::Header& header = file.header(part);
  const bool has_rgb = hasChannels(header, {"R", "G", "B"});
  if (!has_rgb && hasChannels(header, {"RY", "BY"})) return file.readLuminanceChroma();
  std::vector<std::string> names = has_rgb ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"};
  if (hasChannels(header, {"A"})) names.emplace_back("A");
  std::vector<Image> images = file.readImages(part, std::span(&names, 1));
  return has_rgb ? std::move(images.front()) : spreadGrey(images.front());
}

}  // namespace

Image decodeExr(std::span<const std::byte> bytes, const std::string& label) {
  return guardExr(label, [&] {
    const ExrFile file(bytes, label);
    return readColour(file, findColourPart(file, label));
  });
}

}  // namespace nephroid
