// Daylight after Preetham, Shirley and Smits 1999: the luminance and chromaticity of a clear sky as Perez functions of
// the angles to the zenith and to the sun, with coefficients linear in turbidity, and polynomial zenith values.
//
// Limits: no sun disc, no twilight; above turbidity 6 or with the sun below some 5 degrees the fit is only plausible.
// Chromaticities beyond Rec. 709 are clipped at 0. Only the shape is the model's: the scale is set by the irradiance
// that is asked for, integrated over the texels of the image, so that no error of the fit or the sampling is left in
// it.
#include "scene/sky.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/directions.h"

namespace nephroid {
namespace {

constexpr double kPiDouble = 3.14159265358979323846;
constexpr double kGroundAlbedo = 0.2;

/// Perez et al.: A darkens or brightens the horizon, B its gradient, C the region about the sun, D its width, E
/// back-scatter.
struct Perez {
  double a, b, c, d, e;
  double at(double cos_zenith, double gamma) const {
    const double cos_gamma = std::cos(gamma);
    return (1 + a * std::exp(b / cos_zenith)) * (1 + c * std::exp(d * gamma) + e * cos_gamma * cos_gamma);
  }
};

Perez perezLuminance(double t) {
  return {0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771, -0.0670 * t + 0.3703};
}
Perez perezX(double t) {
  return {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989, -0.0033 * t + 0.0452};
}
Perez perezY(double t) {
  return {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537, -0.0109 * t + 0.0529};
}

using Cubic = std::array<double, 4>;

/// Rows multiply t², t, 1; columns the cube, square, first power of the sun's zenith angle, and 1.
double evaluateZenith(const std::array<Cubic, 3>& rows, double t, double theta) {
  double value = 0;
  for (const Cubic& row : rows) value = value * t + ((row[0] * theta + row[1]) * theta + row[2]) * theta + row[3];
  return value;
}

double zenithX(double t, double theta) {
  return evaluateZenith({{{0.00166, -0.00375, 0.00209, 0.0},
                          {-0.02903, 0.06377, -0.03202, 0.00394},
                          {0.11693, -0.21196, 0.06052, 0.25886}}},
                        t, theta);
}
double zenithY(double t, double theta) {
  return evaluateZenith({{{0.00275, -0.00610, 0.00317, 0.0},
                          {-0.04214, 0.08970, -0.04153, 0.00516},
                          {0.15346, -0.26756, 0.06670, 0.26688}}},
                        t, theta);
}

/// Linear Rec. 709 of a luminance and CIE xy chromaticity (D65 white), out-of-gamut parts clipped.
dvec3 rgbFromChromaticity(double luminance, double x, double y) {
  const double sum = luminance / y;
  const dvec3 xyz(x * sum, luminance, (1 - x - y) * sum);
  return glm::max(dvec3(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                        -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                        0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z),
                  dvec3(0));
}

/// The model at one sun position, without a scale: 1 is the luminance of the zenith.
class SkyModel {
 public:
  explicit SkyModel(const SkySettings& settings)
      : sun_(glm::normalize(dvec3(directionTowards(settings.azimuth_deg, settings.elevation_deg)))),
        luminance_(perezLuminance(settings.turbidity)),
        x_(perezX(settings.turbidity)),
        y_(perezY(settings.turbidity)) {
    const double theta = std::acos(std::clamp(sun_.y, 0.0, 1.0));
    zenith_x_ = zenithX(settings.turbidity, theta) / x_.at(1.0, theta);
    zenith_y_ = zenithY(settings.turbidity, theta) / y_.at(1.0, theta);
    zenith_luminance_ = 1.0 / luminance_.at(1.0, theta);
  }

  /// @param dir unit, above the horizon
  dvec3 radianceFrom(dvec3 dir) const {
    const double gamma = std::acos(std::clamp(glm::dot(dir, sun_), -1.0, 1.0));
    const double luminance = std::max(0.0, zenith_luminance_ * luminance_.at(dir.y, gamma));
    return rgbFromChromaticity(luminance, zenith_x_ * x_.at(dir.y, gamma), zenith_y_ * y_.at(dir.y, gamma));
  }

 private:
  dvec3 sun_;
  Perez luminance_, x_, y_;
  double zenith_x_ = 0, zenith_y_ = 0, zenith_luminance_ = 0;
};

/// The unit direction of the centre of a texel.
dvec3 directionOfTexel(int x, int y, int width, int height) {
  const double theta = kPiDouble * (y + 0.5) / height;
  const double phi = 2 * kPiDouble * ((x + 0.5) / width - 0.5);
  return {std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta)};
}

}  // namespace

Image renderSky(const SkySettings& settings, int width, int height) {
  const SkyModel model(settings);
  Image image(width, height, 3);
  double irradiance = 0;
  for (int y = 0; y < height; ++y) {
    // ∫ cos θ dω over the texel, exact: Δφ/2 · (sin² θ1 − sin² θ0).
    const double s0 = std::sin(kPiDouble * y / height), s1 = std::sin(kPiDouble * (y + 1) / height);
    const double weight = kPiDouble / width * (s1 * s1 - s0 * s0);
    for (int x = 0; x < width; ++x) {
      const dvec3 dir = directionOfTexel(x, y, width, height);
      if (dir.y <= 0) continue;
      const dvec3 radiance = model.radianceFrom(dir);
      image.setRgb(x, y, vec3(radiance));
      irradiance += weight * (radiance.x + radiance.y + radiance.z) / 3;
    }
  }
  const vec3 scale = settings.tint * static_cast<float>(settings.irradiance / irradiance);
  const vec3 ground = settings.tint * static_cast<float>(settings.irradiance * kGroundAlbedo / kPiDouble);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.setRgb(x, y, 2 * y + 1 < height ? image.rgb(x, y) * scale : ground);
  return image;
}

Environment makeSky(const SkySettings& settings) {
  Environment sky;
  sky.radiance = std::make_shared<const Image>(renderSky(settings, 512, 256));
  sky.source = fmt::format("sky:turbidity={},elevation={},azimuth={},irradiance={}", settings.turbidity,
                           settings.elevation_deg, settings.azimuth_deg, settings.irradiance);
  return sky;
}

}  // namespace nephroid
