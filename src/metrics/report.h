// A comparison as a page: one file of HTML that needs nothing else, neither a network nor a server.
#pragma once

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "metrics/metrics.h"

namespace nephroid {

/// One of the two pictures.
struct ReportPicture {
  std::string name;     ///< of the file
  const Image& pixels;  ///< scene-referred, or linear as shown
  std::map<std::string, std::string> metadata;
};

/// What was compared, and its figures.
struct ReportContent {
  ReportPicture image, reference;
  std::span<const std::uint8_t> mask;  ///< one entry per pixel; empty: all count
  Viewing viewing;
  std::string summary;  ///< a sentence or two: which layers, how many pixels
  dvec3 image_mean{0}, reference_mean{0};
  std::vector<std::pair<std::string, double>> figures;  ///< by metric
};

/// The page: both pictures under a divider, at any exposure; maps of relMSE, FLIP and signed difference with their
/// scales; histograms; the figures; both files' metadata. Text from files is escaped.
/// @throws InputError as the metrics, ResourceError
std::string makeReport(const ReportContent& content);

}  // namespace nephroid
