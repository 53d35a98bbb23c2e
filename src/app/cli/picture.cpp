#include "app/cli/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <set>

#include "api/display.h"
#include "app/cli/options.h"
#include "core/file.h"
#include "core/image/image_io.h"
#include "nephroid/error.h"

namespace nephroid::cli {
namespace {

constexpr double kMaxExposure = 100;  // EV; 2^100 leaves nothing of any picture but black or white

bool isPng(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension == ".png") return true;
  if (extension == ".exr") return false;
  throw UsageError(fmt::format("-o: '{}' is neither .exr nor .png; the ending chooses the format", path.string()));
}

std::vector<std::string> layerNames(const LayeredImage& image) {
  std::vector<std::string> names;
  for (const Layer& layer : image.layers) names.push_back(layer.name);
  return names;
}

DisplayOptions toDisplayOptions(const PictureOptions& options) {
  DisplayOptions display;
  display.tone_map = options.tone_map == "filmic" ? ToneMap::kFilmic : ToneMap::kClamp;
  if (options.exposure == "auto") return display;
  const std::string& text = options.exposure;
  float exposure_ev = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), exposure_ev);
  if (error != std::errc{} || end != text.data() + text.size() || !(std::abs(exposure_ev) <= kMaxExposure))
    throw UsageError(
        fmt::format("--exposure: '{}' is neither auto nor a number from -{} to {}", text, kMaxExposure, kMaxExposure));
  display.exposure_ev = exposure_ev;
  return display;
}

}  // namespace

void addPictureOptions(CLI::App& app, PictureOptions& options) {
  addValue(app, "--exposure", options.exposure, "auto|EV",
           {"Of a PNG: radiance is multiplied by 2^EV; auto brings the average to middle grey.", "auto",
            "auto or -100 to 100", "EV"});
  addValue(app, "--tonemap", options.tone_map, "CURVE",
           {"Of a PNG: none clips what is brighter than white, filmic rolls it off.", "none", "none|filmic", ""},
           checkChoice({"none", "filmic"}));
  addSwitch(app, "--half", options.half, "EXR with 16-bit instead of 32-bit floats.");
}

std::vector<std::string> pictureFiles(const std::string& output, const std::vector<std::string>& layers) {
  std::vector<std::string> files(layers.size(), output);
  const std::filesystem::path path(output);
  if (!isPng(path)) return files;
  const auto beauty = std::find(layers.begin(), layers.end(), "beauty");
  const std::size_t main_layer = beauty == layers.end() ? 0 : static_cast<std::size_t>(beauty - layers.begin());
  for (std::size_t i = 0; i < layers.size(); ++i)
    if (i != main_layer) files[i] = (path.parent_path() / (path.stem().string() + "." + layers[i] + ".png")).string();
  return files;
}

void checkPicture(const std::string& output, const std::vector<std::string>& layers, const PictureOptions& options) {
  toDisplayOptions(options);
  const std::vector<std::string> files = pictureFiles(output, layers);
  for (const std::string& file : std::set<std::string>(files.begin(), files.end())) checkWritable(file);
}

std::vector<std::string> writePicture(const std::string& output, const LayeredImage& image,
                                      const PictureOptions& options) {
  if (!isPng(output)) {
    writeExr(output, image, options.half);
    return {output};
  }
  std::vector<std::string> files = pictureFiles(output, layerNames(image));
  const DisplayOptions display = toDisplayOptions(options);
  for (std::size_t i = 0; i < files.size(); ++i)
    writePng(files[i], displayLayer(image, image.layers[i].name, display), image.metadata);
  return files;
}

}  // namespace nephroid::cli
