// Environments by name: a lat-long picture from a file, or the analytic sky.
#include <fmt/format.h>

#include "core/image/image_io.h"
#include "core/params.h"
#include "nephroid/error.h"
#include "scene/edit.h"
#include "scene/sky.h"

namespace nephroid {
namespace {

Environment makeSkyFrom(std::string_view settings) {
  ParamSet params(std::vector<ParamSpec>{
      {"turbidity", 3.0F, 1.7, 10.0, "", "haze: 2 is arctic, 3 clear, 10 haze", {}},
      {"elevation", 45.0F, 0.0, 90.0, "deg", "height of the sun above the horizon", {}},
      {"azimuth", 0.0F, -360.0, 360.0, "deg", "where the sun stands: 0 is +Z, 90 is +X", {}},
      {"irradiance", 1.5F, 0.0, 1e9, "W/m^2", "on a horizontal plane", {}},
  });
  for (const auto& [key, value] : parseKeyValues(settings, ',')) params.set(key, value);
  return makeSky({.turbidity = params.getFloat("turbidity"),
                  .elevation_deg = params.getFloat("elevation"),
                  .azimuth_deg = params.getFloat("azimuth"),
                  .irradiance = params.getFloat("irradiance")});
}

/// Three channels from one, three or four.
Image asRgb(const Image& image) {
  Image rgb(image.width, image.height, 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) rgb.setRgb(x, y, glm::max(image.rgb(x, y), vec3(0)));
  return rgb;
}

Environment loadPicture(const std::string& path) {
  const DecodedImage decoded = loadImage(path);
  const auto* image = std::get_if<Image>(&decoded);
  if (image == nullptr)
    throw InputError(
        fmt::format("{}: an 8-bit picture has no radiances; an environment must be EXR or Radiance HDR", path));
  if (image->empty()) throw InputError(fmt::format("{}: the picture is empty", path));
  Environment environment;
  environment.radiance = std::make_shared<const Image>(asRgb(*image));
  environment.source = path;
  return environment;
}

}  // namespace

Environment loadEnvironment(std::string_view source, float rotation_deg, float scale) {
  if (!(scale >= 0.0F)) throw UsageError(fmt::format("--env-scale {}: expected a number that is not negative", scale));
  Environment environment;
  try {
    if (source == "sky")
      environment = makeSkyFrom({});
    else if (source.starts_with("sky:"))
      environment = makeSkyFrom(source.substr(4));
    else
      environment = loadPicture(std::string(source));
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("--env {}: {}", source, error.what()));
  }
  environment.rotation_deg = rotation_deg;
  environment.scale = scale;
  return environment;
}

}  // namespace nephroid
