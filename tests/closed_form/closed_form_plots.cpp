// Draws the pictures of docs/closed_forms.md: the rendered caustic, the formula's picture, and both profiles in one
// plot.
//
// Usage: closed_form_plots FOLDER. Writes FOLDER/{ball_before,ball_behind,wave_shallow,wave_deep,ring,mirror,blur}.png
// and prints each relative L1. In a plot the formula is the dark line, the renderer the orange one beneath it; the
// vertical axis is the square root of irradiance, from 0 to the highest.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <numeric>

#include "closed_form/ball.h"
#include "closed_form/blur.h"
#include "closed_form/mirrors.h"
#include "closed_form/profile.h"
#include "closed_form/ring.h"
#include "closed_form/wave.h"
#include "core/image/image_io.h"
#include "core/image/tonemap.h"

namespace nephroid::closed_form {
namespace {

constexpr int kPanel = 180, kGap = 6, kPlot = 300;

/// One case, ready to be drawn.
struct Comparison {
  std::string name;
  Image rendered, predicted;  ///< irradiance, one or three channels, any size
  std::vector<double> measured_profile, predicted_profile;
};

/// Mean of the source's pixels under each pixel of a kPanel² square. Pictures that do not vary along their height are
/// longer than wide: they are pressed together, which takes the noise out.
void drawPanel(Image& canvas, int left, const Image& source, float scale) {
  for (int y = 0; y < kPanel; ++y) {
    for (int x = 0; x < kPanel; ++x) {
      const int fx = x * source.width / kPanel, tx = std::max((x + 1) * source.width / kPanel, fx + 1);
      const int fy = y * source.height / kPanel, ty = std::max((y + 1) * source.height / kPanel, fy + 1);
      double sum = 0.0;
      for (int sy = fy; sy < ty; ++sy)
        for (int sx = fx; sx < tx; ++sx) sum += static_cast<double>(source.at(sx, sy)[0]);
      const float mean = static_cast<float>(sum / ((tx - fx) * (ty - fy)));
      canvas.setRgb(left + x, y, vec3(mean * scale));
    }
  }
}

void drawCurve(Image& canvas, int left, const std::vector<double>& values, double top, vec3 color, int thickness) {
  int last = -1;
  for (int x = 0; x < kPlot; ++x) {
    const double at = (x + 0.5) / kPlot * static_cast<double>(values.size()) - 0.5;
    const double clamped = std::clamp(at, 0.0, static_cast<double>(values.size() - 1));
    const auto i = std::min(static_cast<std::size_t>(clamped), values.size() - 2);
    const double value = values[i] + (clamped - static_cast<double>(i)) * (values[i + 1] - values[i]);
    const int row =
        std::clamp(static_cast<int>((1.0 - std::sqrt(std::max(value, 0.0) / top)) * (kPanel - 8)) + 4, 0, kPanel - 1);
    const int from = last < 0 ? row : std::min(row, last), to = last < 0 ? row : std::max(row, last);
    for (int y = from - thickness; y <= to + thickness; ++y)
      if (y >= 0 && y < kPanel) canvas.setRgb(left + x, y, color);
    last = row;
  }
}

void drawPlot(Image& canvas, int left, const Comparison& c) {
  for (int y = 0; y < kPanel; ++y)
    for (int x = 0; x < kPlot; ++x) canvas.setRgb(left + x, y, vec3(y % 43 == 4 || x % 75 == 0 ? 0.8F : 1.0F));
  const double top = 1.05 * *std::max_element(c.predicted_profile.begin(), c.predicted_profile.end());
  drawCurve(canvas, left, c.measured_profile, top, vec3(1.0F, 0.35F, 0.05F), 1);
  drawCurve(canvas, left, c.predicted_profile, top, vec3(0.02F, 0.03F, 0.08F), 0);
}

/// The brightest of the profile is shown at twice white and its mean at 10 % of white, both as well as one factor can.
float chooseScale(const std::vector<double>& profile) {
  const double mean = std::accumulate(profile.begin(), profile.end(), 0.0) / static_cast<double>(profile.size());
  const double highest = *std::max_element(profile.begin(), profile.end());
  return static_cast<float>(std::sqrt(2.0 / highest * 0.1 / mean));
}

void draw(const Comparison& c, const std::filesystem::path& folder) {
  Image canvas(2 * (kPanel + kGap) + kPlot, kPanel, 3, 1.0F);
  const float scale = chooseScale(c.predicted_profile);
  drawPanel(canvas, 0, c.rendered, scale);
  drawPanel(canvas, kPanel + kGap, c.predicted, scale);
  drawPlot(canvas, 2 * (kPanel + kGap), c);
  writePng(folder / (c.name + ".png"), toDisplay(canvas, 0.0F, ToneMap::kClamp));
  fmt::print("{}: relative L1 {:.5f}\n", c.name, relativeL1(c.measured_profile, c.predicted_profile));
}

/// A picture of size² pixels from a function of the place in [−1, 1]².
Image paint(int size, const std::function<double(double x, double y)>& value) {
  Image image(size, size, 1);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      image.at(x, y)[0] = static_cast<float>(value(2.0 * (x + 0.5) / size - 1.0, 2.0 * (y + 0.5) / size - 1.0));
  return image;
}

Image paintRings(const std::vector<double>& profile) {
  return paint(2 * static_cast<int>(profile.size()), [&](double x, double y) {
    const auto ring = static_cast<std::size_t>(std::hypot(x, y) * static_cast<double>(profile.size()));
    return ring < profile.size() ? profile[ring] : 0.0;
  });
}

Image paintColumns(const std::vector<double>& profile) {
  return paint(static_cast<int>(profile.size()), [&](double x, double) {
    return profile[static_cast<std::size_t>(0.5 * (x + 1.0) * static_cast<double>(profile.size()))];
  });
}

/// Turns of revolution: the corners beyond the profile are left black in both pictures.
Image cutCorners(Image image) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (std::hypot(x + 0.5 - 0.5 * image.width, y + 0.5 - 0.5 * image.height) > 0.5 * image.width)
        image.setRgb(x, y, vec3(0.0F));
  return image;
}

Comparison compareBall(const std::string& name, const BallCase& c) {
  const PlanePicture picture = renderPlane(makeBallScene(c, 512), ballView(c, 1024), std::uint64_t{1} << 21);
  return {name, cutCorners(picture.irradiance), paintRings(ballIrradiance(c, 240)),
          picture.ringMeans(c.view_radius, 64), ballIrradiance(c, 64)};
}

Comparison compareWave(const std::string& name, const WaveCase& c) {
  const PlanePicture picture = renderPlane(makeWaveScene(c, 512), waveView(c), std::uint64_t{1} << 20);
  const std::vector<double> predicted = waveIrradiance(c, 512);
  return {name, picture.irradiance, paintColumns(predicted), picture.columnMeans(), predicted};
}

Comparison compareRing() {
  const RingCase c;
  const PlanePicture picture = renderPlane(makeRingScene(c, 2048), ringView(c, 512), std::uint64_t{1} << 22);
  const Image predicted = ringIrradiance(c, 512);
  return {"ring", cutCorners(picture.irradiance), predicted, axisProfile(picture.irradiance, 32),
          axisProfile(predicted, 32)};
}

Comparison compareMirror() {
  const SphericalMirrorCase c;
  const PlaneView view = receiverView(c.plane, 2.0 * c.receiver_radius, 1024);
  const PlanePicture picture = renderPlane(makeSphericalMirrorScene(c, 256, 512), view, std::uint64_t{1} << 20);
  return {"mirror", cutCorners(picture.irradiance), paintRings(sphericalIrradiance(c, 240)),
          picture.ringMeans(c.receiver_radius, 64), sphericalIrradiance(c, 64)};
}

Comparison compareBlur() {
  const BlurCase c;
  const PlanePicture picture = renderPlane(makeBlurScene(c), blurView(c), std::uint64_t{1} << 22);
  const std::vector<double> predicted = blurIrradiance(c, 512);
  return {"blur", picture.irradiance, paintColumns(predicted), picture.columnMeans(), predicted};
}

void drawAll(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  draw(compareBall("ball_before", {.gap = 0.015, .view_radius = 0.03}), folder);
  draw(compareBall("ball_behind", {.gap = 0.05, .view_radius = 0.1}), folder);
  draw(compareWave("wave_shallow", {.depth = 0.5}), folder);
  draw(compareWave("wave_deep", {.depth = 2.0}), folder);
  draw(compareRing(), folder);
  draw(compareMirror(), folder);
  draw(compareBlur(), folder);
}

}  // namespace
}  // namespace nephroid::closed_form

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: {} FOLDER\n", argv[0]);
    return 2;
  }
  try {
    nephroid::closed_form::drawAll(argv[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
