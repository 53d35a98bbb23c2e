// Curves on logarithmic axes as an SVG drawing.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace nephroid::cli {

struct PlotCurve {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< x, y; those that are not > 0 and finite are left out
};

/// One pair of axes.
struct PlotPanel {
  std::string title, x_label, y_label;
  std::vector<PlotCurve> curves;  ///< at most 6: as many as colours
};

/// Panels side by side, row by row; under them a legend of the names of all curves. One file that needs nothing beside
/// it. Rows may differ in length.
std::string drawPlots(const std::vector<std::vector<PlotPanel>>& rows);

}  // namespace nephroid::cli
