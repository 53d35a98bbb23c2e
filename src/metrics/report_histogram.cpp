#include "metrics/report_histogram.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace nephroid {
namespace {

constexpr int kStops = 16, kBinsPerStop = 4, kBins = kStops * kBinsPerStop;
constexpr double kWidth = 640.0, kHeight = 200.0, kMargin = 24.0;

struct Histogram {
  std::array<double, kBins> shares{};  ///< of all finite pixels
  double darker = 0.0;
};

double findBrightest(const Image& picture) {
  double brightest = 0.0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      if (const double l = luminance(picture.rgb(x, y)); std::isfinite(l)) brightest = std::max(brightest, l);
  return brightest;
}

Histogram countLuminances(const Image& picture, double brightest) {
  Histogram histogram;
  double count = 0.0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const double l = luminance(picture.rgb(x, y));
      if (!std::isfinite(l)) continue;
      ++count;
      const double stops = l > 0.0 ? std::log2(l / brightest) : -2.0 * kStops;
      const int bin = std::min(static_cast<int>(std::floor((kStops + stops) * kBinsPerStop)), kBins - 1);
      ++(bin < 0 ? histogram.darker : histogram.shares[static_cast<std::size_t>(bin)]);
    }
  for (double& share : histogram.shares) share /= std::max(count, 1.0);
  histogram.darker /= std::max(count, 1.0);
  return histogram;
}

std::string drawSteps(const Histogram& histogram, double highest, const char* name) {
  std::string path;
  for (int bin = 0; bin < kBins; ++bin) {
    const double y = kHeight * (1.0 - histogram.shares[static_cast<std::size_t>(bin)] / highest);
    path += fmt::format("{}{:.1f} {:.1f}H{:.1f}", bin == 0 ? "M" : "L", kWidth * bin / kBins, y,
                        kWidth * (bin + 1) / kBins);
  }
  return fmt::format("<path class=\"{}\" d=\"{}\"/>", name, path);
}

}  // namespace

std::string drawHistogram(const Image& image, const Image& reference) {
  const double brightest = std::max(findBrightest(image), findBrightest(reference));
  const Histogram a = countLuminances(image, brightest), b = countLuminances(reference, brightest);
  const double highest = std::max(
      {*std::max_element(a.shares.begin(), a.shares.end()), *std::max_element(b.shares.begin(), b.shares.end()), 1e-9});
  std::string svg = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Histogram of luminance\">",
                                kWidth, kHeight + kMargin);
  for (int stop = 0; stop <= kStops; stop += 4)
    svg += fmt::format("<text x=\"{:.0f}\" y=\"{}\" text-anchor=\"{}\">{:.3g}</text>", kWidth * stop / kStops,
                       kHeight + kMargin - 6.0,
                       stop == 0        ? "start"
                       : stop == kStops ? "end"
                                        : "middle",
                       brightest * std::exp2(stop - kStops));
  svg += drawSteps(b, highest, "reference") + drawSteps(a, highest, "image") + "</svg>";
  return svg + fmt::format(
                   "<p>Share of pixels by luminance; the highest step is {:.2g} %. Darker: {:.3g} % of the image, "
                   "{:.3g} % of the reference.</p>",
                   100.0 * highest, 100.0 * a.darker, 100.0 * b.darker);
}

}  // namespace nephroid
