// "direct+caustic": a layer, or a sum of layers, of a picture.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/params.h"
#include "metrics/metrics.h"
#include "nephroid/error.h"

namespace nephroid {
namespace {

std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

const Image& findLayer(const LayeredImage& image, std::string_view name) {
  if (const Image* layer = image.find(name)) return *layer;
  std::vector<std::string> names;
  for (const Layer& layer : image.layers) names.push_back(layer.name);
  const std::string nearest = suggestName(name, names);
  const std::string hint = nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
  throw InputError(fmt::format("layer '{}' is not in the image{} (it has: {}); render it with --aov", name, hint,
                               fmt::join(names, ", ")));
}

/// Adds `term` to `sum`; one channel counts for all three.
void addImage(Image& sum, const Image& term) {
  if (sum.channels == term.channels) {
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += term.pixels[i];
    return;
  }
  Image wide(sum.width, sum.height, 3);
  for (int y = 0; y < sum.height; ++y)
    for (int x = 0; x < sum.width; ++x) wide.setRgb(x, y, sum.rgb(x, y) + term.rgb(x, y));
  sum = std::move(wide);
}

}  // namespace

Image evaluateLayerExpression(const LayeredImage& image, std::string_view expression) {
  Image sum;
  for (std::string_view rest = expression;;) {
    const std::size_t plus = rest.find('+');
    const Image& layer = findLayer(image, trim(rest.substr(0, plus)));
    if (sum.empty())
      sum = layer;
    else
      addImage(sum, layer);
    if (plus == std::string_view::npos) return sum;
    rest.remove_prefix(plus + 1);
  }
}

}  // namespace nephroid
