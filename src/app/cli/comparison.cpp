#include "app/cli/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "core/file.h"
#include "core/image/image_io.h"
#include "nephroid/error.h"

namespace nephroid::cli {
namespace {

/// A picture's layers, and whether they are what a screen shows.
struct PictureFile {
  LayeredImage image;
  bool display_referred = false;
};

/// A picture of any format as layers; what is not EXR is one layer, `beauty`. Files of 8 bits are for screens.
PictureFile readPicture(const std::string& path) {
  constexpr std::array<std::byte, 4> kExrMagic{std::byte{0x76}, std::byte{0x2f}, std::byte{0x31}, std::byte{0x01}};
  const std::vector<std::byte> bytes = readFile(path);
  if (bytes.size() >= kExrMagic.size() && std::equal(kExrMagic.begin(), kExrMagic.end(), bytes.begin()))
    return {readExr(path), false};
  const DecodedImage decoded = decodeImage(bytes, path);
  Image image = toLinear(decoded);
  LayeredImage layered{.width = image.width, .height = image.height, .metadata = readPngTexts(bytes)};
  layered.layers.push_back({"beauty", std::move(image)});
  return {std::move(layered), std::holds_alternative<ByteImage>(decoded)};
}

/// `beauty` if both have it, else the first layer that both have.
std::string chooseLayer(const LayeredImage& image, const LayeredImage& reference, const CompareOptions& options) {
  if (!options.layer.empty()) return options.layer;
  if (image.find("beauty") != nullptr && reference.find("beauty") != nullptr) return "beauty";
  for (const Layer& layer : image.layers)
    if (reference.find(layer.name) != nullptr) return layer.name;
  throw InputError(fmt::format("{} and {} have no layer in common; choose with --layer and --reference-layer",
                               options.image, options.reference));
}

/// evaluateLayerExpression, with the file's name in its message.
Image evaluateLayer(const LayeredImage& image, const std::string& expression, const std::string& path) {
  try {
    return evaluateLayerExpression(image, expression);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path, error.what()));
  }
}

void checkSameSize(const Image& image, const std::string& path, int width, int height, const std::string& reference) {
  if (image.width == width && image.height == height) return;
  throw InputError(fmt::format("{} is {}x{} px, but {} is {}x{} px; only pictures of one size can be compared", path,
                               image.width, image.height, reference, width, height));
}

/// excludeNotFinite, said on stderr, with the files' names in its messages.
NotFinitePixels leaveOutNotFinite(const Image& image, const Image& reference, std::vector<std::uint8_t>& mask,
                                  const CompareOptions& options) {
  try {
    const NotFinitePixels found = excludeNotFinite(image, reference, mask);
    const auto warn = [](const std::string& path, std::size_t count) {
      if (count > 0) warnOnce(fmt::format("{}: pixels that are NaN or infinite, left out: {}", path, count));
    };
    warn(options.image, found.in_image);
    warn(options.reference, found.in_reference);
    return found;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{} and {}: {}", options.image, options.reference, error.what()));
  }
}

/// 255 where a pixel counts, 0 elsewhere.
std::vector<std::uint8_t> loadMask(const std::string& path, const Image& image, const std::string& image_path) {
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(image.width) * image.height, 255);
  if (path.empty()) return mask;
  const DecodedImage decoded = loadImage(path);
  const auto* bytes = std::get_if<ByteImage>(&decoded);
  if (bytes == nullptr) throw InputError(fmt::format("{}: is a float picture; a mask is an 8-bit PNG", path));
  checkSameSize(image, image_path, bytes->width, bytes->height, path);
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = bytes->pixels[4 * i] == 255 ? 255 : 0;
  if (std::count(mask.begin(), mask.end(), 255) == 0)
    throw InputError(fmt::format("{}: no pixel has the value 255; those are the ones that count", path));
  return mask;
}

std::vector<const Metric*> chooseMetrics(const std::string& names) {
  std::vector<const Metric*> chosen;
  for (const std::string& name : splitList(names)) chosen.push_back(&findMetric(name));
  if (chosen.empty())
    for (const Metric& metric : metrics()) chosen.push_back(&metric);
  return chosen;
}

}  // namespace

Comparison comparePictures(const CompareOptions& options) {
  const std::vector<const Metric*> chosen = chooseMetrics(options.metrics);
  PictureFile image_file = readPicture(options.image);
  PictureFile reference_file = readPicture(options.reference);
  Comparison comparison;
  comparison.viewing = {.display_referred = image_file.display_referred && reference_file.display_referred,
                        .pixels_per_degree = options.pixels_per_degree};
  comparison.layer = chooseLayer(image_file.image, reference_file.image, options);
  comparison.reference_layer = options.reference_layer.empty() ? comparison.layer : options.reference_layer;
  comparison.image = evaluateLayer(image_file.image, comparison.layer, options.image);
  comparison.reference = evaluateLayer(reference_file.image, comparison.reference_layer, options.reference);
  const Image &image = comparison.image, &reference = comparison.reference;
  checkSameSize(image, options.image, reference.width, reference.height, options.reference);
  if (image.channels != reference.channels)
    throw InputError(fmt::format("{} has {} channels in '{}', but {} has {} in '{}'; compare like with like",
                                 options.image, image.channels, comparison.layer, options.reference, reference.channels,
                                 comparison.reference_layer));
  std::vector<std::uint8_t>& mask = comparison.mask;
  mask = loadMask(options.mask, image, options.image);
  comparison.not_finite = leaveOutNotFinite(image, reference, mask, options);
  comparison.pixel_count = static_cast<std::size_t>(std::count(mask.begin(), mask.end(), 255));
  comparison.image_mean = maskedMean(image, mask);
  comparison.reference_mean = maskedMean(reference, mask);
  for (const Metric* metric : chosen)
    comparison.values.emplace_back(metric->name, metric->compute(image, reference, mask, comparison.viewing));
  comparison.image_metadata = std::move(image_file.image.metadata);
  comparison.reference_metadata = std::move(reference_file.image.metadata);
  return comparison;
}

}  // namespace nephroid::cli
