#include "app/cli/plot_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "metrics/html.h"

namespace nephroid::cli {
namespace {

/// Sizes in the drawing's own unit, about a pixel.
constexpr double kPanelWidth = 300, kPanelHeight = 240, kLeft = 54, kRight = 12, kTop = 28, kBottom = 42;
constexpr double kLegendHeight = 30, kLegendStep = 130;
/// Told apart by eyes that do not tell red from green (Okabe and Ito), and dark enough on white.
constexpr std::array kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#a37500", "#000000"};

/// Powers of ten about values.
struct LogAxis {
  int low = 0, high = 1;
  double begin, end;  ///< in the drawing
  double place(double value) const { return begin + (end - begin) * (std::log10(value) - low) / (high - low); }
};

bool isDrawable(const std::pair<double, double>& p) {
  return std::isfinite(p.first) && std::isfinite(p.second) && p.first > 0.0 && p.second > 0.0;
}

/// @param which  0: x, 1: y
LogAxis fitAxis(const PlotPanel& panel, int which, double begin, double end) {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const PlotCurve& curve : panel.curves) {
    for (const auto& p : curve.points) {
      if (!isDrawable(p)) continue;
      low = std::min(low, which == 0 ? p.first : p.second);
      high = std::max(high, which == 0 ? p.first : p.second);
    }
  }
  LogAxis axis{0, 1, begin, end};
  if (high == 0.0) return axis;
  axis.low = static_cast<int>(std::floor(std::log10(low)));
  axis.high = std::max(static_cast<int>(std::ceil(std::log10(high))), axis.low + 1);
  return axis;
}

std::string drawText(double x, double y, const char* anchor, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, escapeHtml(text));
}

std::string drawLine(double x0, double y0, double x1, double y1, const char* colour) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x0, y0, x1, y1,
                     colour);
}

std::string drawGrid(const LogAxis& x, const LogAxis& y) {
  std::string svg;
  const auto drawAt = [&](const LogAxis& axis, double value, const char* colour) {
    const double at = axis.place(value);
    svg += &axis == &x ? drawLine(at, y.begin, at, y.end, colour) : drawLine(x.begin, at, x.end, at, colour);
  };
  for (const LogAxis* axis : {&x, &y})
    for (int decade = axis->low; decade < axis->high; ++decade)
      for (int k = 2; k < 10; ++k) drawAt(*axis, k * std::pow(10.0, decade), "#eeeeee");
  for (const LogAxis* axis : {&x, &y})
    for (int decade = axis->low; decade <= axis->high; ++decade) drawAt(*axis, std::pow(10.0, decade), "#bbbbbb");
  for (int decade = x.low; decade <= x.high; ++decade)
    svg +=
        drawText(x.place(std::pow(10.0, decade)), y.begin + 15, "middle", fmt::format("{:g}", std::pow(10.0, decade)));
  for (int decade = y.low; decade <= y.high; ++decade)
    svg +=
        drawText(x.begin - 5, y.place(std::pow(10.0, decade)) + 4, "end", fmt::format("{:g}", std::pow(10.0, decade)));
  return svg;
}

std::string drawCurve(const PlotCurve& curve, const LogAxis& x, const LogAxis& y, const char* colour) {
  std::string line, dots;
  for (const auto& p : curve.points) {
    if (!isDrawable(p)) continue;
    line += fmt::format("{:.1f},{:.1f} ", x.place(p.first), y.place(p.second));
    dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\" fill=\"{}\"/>\n", x.place(p.first),
                        y.place(p.second), colour);
  }
  return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"/>\n{}", line, colour,
                     dots);
}

/// Names of all curves, each once, in order: what a colour stands for.
std::vector<std::string> listNames(const std::vector<std::vector<PlotPanel>>& rows) {
  std::vector<std::string> names;
  for (const auto& row : rows)
    for (const PlotPanel& panel : row)
      for (const PlotCurve& curve : panel.curves)
        if (std::find(names.begin(), names.end(), curve.name) == names.end()) names.push_back(curve.name);
  return names;
}

const char* colourOf(const std::string& name, const std::vector<std::string>& names) {
  const auto index = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  return kColours[index % kColours.size()];
}

std::string drawPanel(const PlotPanel& panel, double left, double top, const std::vector<std::string>& names) {
  const LogAxis x = fitAxis(panel, 0, left + kLeft, left + kPanelWidth - kRight);
  const LogAxis y = fitAxis(panel, 1, top + kPanelHeight - kBottom, top + kTop);
  std::string svg = drawText(0.5 * (x.begin + x.end), top + 17, "middle", panel.title) + drawGrid(x, y);
  svg += drawText(0.5 * (x.begin + x.end), y.begin + 32, "middle", panel.x_label);
  svg += drawText(left + 4, top + 17, "start", panel.y_label);
  for (const PlotCurve& curve : panel.curves) svg += drawCurve(curve, x, y, colourOf(curve.name, names));
  return svg;
}

}  // namespace

std::string drawPlots(const std::vector<std::vector<PlotPanel>>& rows) {
  std::size_t columns = 0;
  for (const auto& row : rows) columns = std::max(columns, row.size());
  const double width = kPanelWidth * static_cast<double>(columns);
  const double height = kPanelHeight * static_cast<double>(rows.size()) + kLegendHeight;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\" "
      "font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      width, height);
  const std::vector<std::string> names = listNames(rows);
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < rows[r].size(); ++c)
      svg += drawPanel(rows[r][c], kPanelWidth * static_cast<double>(c), kPanelHeight * static_cast<double>(r), names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double x = kLeft + kLegendStep * static_cast<double>(i), y = height - 0.5 * kLegendHeight;
    svg += drawLine(x, y, x + 20, y, colourOf(names[i], names)) + drawText(x + 26, y + 4, "start", names[i]);
  }
  return svg + "</svg>\n";
}

}  // namespace nephroid::cli
