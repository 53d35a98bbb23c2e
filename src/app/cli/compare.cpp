// `nephroid compare`: how far a picture is from its reference.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/cli/command.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "core/file.h"
#include "core/image/image_io.h"
#include "metrics/metrics.h"

namespace nephroid::cli {
namespace {

constexpr const char* kExamples = R"(Examples:
  nephroid compare out.exr reference.exr --layer caustic
  nephroid compare out.exr truth.exr --layer direct+caustic --reference-layer beauty --mask floor.png
  nephroid compare a.png b.png --metric rmse,mape --json)";

struct CompareOptions {
  std::string image, reference, layer, reference_layer, mask, metrics;
  float pixels_per_degree = kDefaultPixelsPerDegree;
  bool json = false;
};

struct Comparison {
  std::string layer, reference_layer;
  std::size_t pixel_count = 0;  ///< those that were compared
  NotFinitePixels not_finite;   ///< those that were left out
  dvec3 image_mean{0}, reference_mean{0};
  Viewing viewing;  ///< of `flip`
  std::vector<std::pair<std::string, double>> values;
};

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
  LayeredImage layered{.width = image.width, .height = image.height};
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

Comparison comparePictures(const CompareOptions& options) {
  const std::vector<const Metric*> chosen = chooseMetrics(options.metrics);
  const PictureFile image_file = readPicture(options.image);
  const PictureFile reference_file = readPicture(options.reference);
  Comparison comparison;
  comparison.viewing = {.display_referred = image_file.display_referred && reference_file.display_referred,
                        .pixels_per_degree = options.pixels_per_degree};
  comparison.layer = chooseLayer(image_file.image, reference_file.image, options);
  comparison.reference_layer = options.reference_layer.empty() ? comparison.layer : options.reference_layer;
  const Image image = evaluateLayer(image_file.image, comparison.layer, options.image);
  const Image reference = evaluateLayer(reference_file.image, comparison.reference_layer, options.reference);
  checkSameSize(image, options.image, reference.width, reference.height, options.reference);
  if (image.channels != reference.channels)
    throw InputError(fmt::format("{} has {} channels in '{}', but {} has {} in '{}'; compare like with like",
                                 options.image, image.channels, comparison.layer, options.reference, reference.channels,
                                 comparison.reference_layer));
  std::vector<std::uint8_t> mask = loadMask(options.mask, image, options.image);
  comparison.not_finite = leaveOutNotFinite(image, reference, mask, options);
  comparison.pixel_count = static_cast<std::size_t>(std::count(mask.begin(), mask.end(), 255));
  comparison.image_mean = maskedMean(image, mask);
  comparison.reference_mean = maskedMean(reference, mask);
  for (const Metric* metric : chosen)
    comparison.values.emplace_back(metric->name, metric->compute(image, reference, mask, comparison.viewing));
  return comparison;
}

dvec3 meanRatio(const Comparison& comparison) {
  dvec3 ratio(0);
  for (int c = 0; c < 3; ++c) ratio[c] = comparison.image_mean[c] / comparison.reference_mean[c];
  return ratio;
}

const char* flipName(const Viewing& viewing) { return viewing.display_referred ? "LDR" : "HDR"; }

/// Which FLIP it is. Other metrics are the same however pictures are looked at.
std::string describeMetric(const std::string& name, const Viewing& viewing) {
  if (name != "flip") return "";
  return fmt::format("  {}, {} pixels per degree", flipName(viewing), viewing.pixels_per_degree);
}

std::string formatComparison(const Comparison& comparison) {
  const auto row = [](const char* name, const dvec3& v) {
    return fmt::format("{:<16} {:>12.6g} {:>12.6g} {:>12.6g}\n", name, v.x, v.y, v.z);
  };
  std::string text = fmt::format("layer {}", comparison.layer);
  if (comparison.reference_layer != comparison.layer) text += fmt::format(" against {}", comparison.reference_layer);
  text += fmt::format(", {} pixels", comparison.pixel_count);
  const NotFinitePixels& bad = comparison.not_finite;
  if (bad.in_image + bad.in_reference > 0)
    text +=
        fmt::format(", left out as not finite: {} of the image, {} of the reference", bad.in_image, bad.in_reference);
  text += fmt::format("\n{:<16} {:>12} {:>12} {:>12}\n", "", "R", "G", "B");
  text += row("mean", comparison.image_mean) + row("reference mean", comparison.reference_mean);
  text += row("ratio", meanRatio(comparison));
  for (const auto& [name, value] : comparison.values)
    text += fmt::format("{:<16} {:>12.6g}{}\n", name, value, describeMetric(name, comparison.viewing));
  return text;
}

/// What JSON cannot say, as a ratio to black, becomes null.
std::string formatComparisonJson(const CompareOptions& options, const Comparison& comparison) {
  const auto triple = [](const dvec3& v) { return std::array<double, 3>{v.x, v.y, v.z}; };
  nlohmann::ordered_json values = nlohmann::ordered_json::object();
  for (const auto& [name, value] : comparison.values) values[name] = value;
  const nlohmann::ordered_json json{
      {"image", options.image},
      {"reference", options.reference},
      {"mask", options.mask},
      {"layer", comparison.layer},
      {"reference_layer", comparison.reference_layer},
      {"pixels", comparison.pixel_count},
      {"not_finite", {{"image", comparison.not_finite.in_image}, {"reference", comparison.not_finite.in_reference}}},
      {"mean", triple(comparison.image_mean)},
      {"reference_mean", triple(comparison.reference_mean)},
      {"ratio", triple(meanRatio(comparison))},
      {"metrics", values},
      {"flip", {{"kind", flipName(comparison.viewing)}, {"pixels_per_degree", comparison.viewing.pixels_per_degree}}}};
  // Names of files need not be UTF-8, which JSON must be.
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

ExitCode runCompare(const CompareOptions& options) {
  if (options.image.empty() || options.reference.empty())
    throw UsageError("compare: two pictures are needed: nephroid compare IMAGE REFERENCE");
  const Comparison comparison = comparePictures(options);
  writeStdout(options.json ? formatComparisonJson(options, comparison) : formatComparison(comparison));
  return ExitCode::kDone;
}

std::string metricNames() {
  std::vector<std::string> names;
  for (const Metric& metric : metrics()) names.push_back(metric.name);
  return fmt::format("{}", fmt::join(names, "|"));
}

std::string describeMetrics() {
  std::string text = "Metrics:\n";
  for (const Metric& metric : metrics()) text += fmt::format("  {:<10} {}\n", metric.name, metric.text);
  text += "Pixels that are NaN or infinite in either picture are left out, counted and warned about.\n";
  return text + "\n" + kExamples;
}

}  // namespace

Command addCompareCommand(CLI::App& root) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App* app = addCommand(root, "compare", "Tell how far a picture is from its reference.", describeMetrics());
  addValue(*app, "IMAGE", options->image, "IMAGE", {"The picture: EXR, PNG, JPEG, WebP or HDR.", "", "", ""});
  addValue(*app, "REFERENCE", options->reference, "REFERENCE", {"What it should look like; same size.", "", "", ""});
  addValue(*app, "--layer", options->layer, "LAYERS",
           {"Layer of the EXR, or a sum such as direct+caustic.", "beauty, or else the first that both have", "", ""});
  addValue(*app, "--reference-layer", options->reference_layer, "LAYERS",
           {"Layer of the reference, where it has another name.", "as --layer", "", ""});
  addValue(*app, "--mask", options->mask, "FILE",
           {"A PNG of the same size; pixels of value 255 count.", "all", "", ""});
  addValue(*app, "--metric", options->metrics, "LIST", {"Metrics, separated by commas.", "all", metricNames(), ""});
  addValue(*app, "--pixels-per-degree", options->pixels_per_degree, "P",
           {"For flip: how many pixels the eye that looks at the pictures has in a degree; more are further away.",
            fmt::format("{}", kDefaultPixelsPerDegree),
            fmt::format("{} to {}", kMinPixelsPerDegree, kMaxPixelsPerDegree), "px/deg"},
           checkNumber(double{kMinPixelsPerDegree}, double{kMaxPixelsPerDegree}));
  addSwitch(*app, "--json", options->json, "Print JSON.");
  return {app, [options] { return runCompare(*options); }};
}

}  // namespace nephroid::cli
