#include "metrics/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/image/image_io.h"
#include "core/image/tonemap.h"
#include "metrics/html.h"
#include "metrics/report_files.h"
#include "metrics/report_histogram.h"
#include "metrics/report_pictures.h"

namespace nephroid {
namespace {

/// Of squared relative errors: from 1 % off to ten times off.
constexpr ColourScale kRelMseScale{.logarithmic = true, .lower = 1e-4F, .upper = 1e2F};
constexpr ColourScale kFlipScale{};

/// Of the image's luminance over that of the reference.
Image subtractLuminances(const Image& image, const Image& reference) {
  Image difference(image.width, image.height, 1);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      *difference.at(x, y) = luminance(image.rgb(x, y)) - luminance(reference.rgb(x, y));
  return difference;
}

/// Ends where 99.5 % of the pixels are within: a few pixels would make all others white.
ColourScale makeDifferenceScale(const Image& difference) {
  std::vector<float> sizes;
  for (const float value : difference.pixels)
    if (std::isfinite(value)) sizes.push_back(std::abs(value));
  float end = 0.0F;
  if (!sizes.empty()) {
    const auto rank = sizes.begin() + static_cast<std::ptrdiff_t>((sizes.size() - 1) * 995 / 1000);
    std::nth_element(sizes.begin(), rank, sizes.end());
    end = *rank > 0.0F ? *rank : *std::max_element(rank, sizes.end());
  }
  if (end == 0.0F) end = 1.0F;
  return {.diverging = true, .lower = -end, .upper = end};
}

std::string formatColour(vec3 colour) {
  return fmt::format("rgb({:.0f} {:.0f} {:.0f})", 255.0F * colour.x, 255.0F * colour.y, 255.0F * colour.z);
}

/// The value at a part of the way along the scale.
float valueAt(const ColourScale& scale, float t) {
  if (scale.logarithmic) return scale.lower * std::pow(scale.upper / scale.lower, t);
  return scale.lower + t * (scale.upper - scale.lower);
}

std::string makeLegend(const ColourScale& scale) {
  constexpr int kColours = 16, kLabels = 4;
  std::string colours, labels;
  for (int i = 0; i <= kColours; ++i)
    colours += ", " + formatColour(scale.colour(valueAt(scale, static_cast<float>(i) / kColours)));
  for (int i = 0; i <= kLabels; ++i)
    labels += fmt::format("<span>{:.3g}</span>", valueAt(scale, static_cast<float>(i) / kLabels));
  return fmt::format(
      "<div class=\"strip\" style=\"background: linear-gradient(to right{})\"></div>"
      "<div class=\"labels\">{}</div>",
      colours, labels);
}

std::string makeFigure(std::string_view id, std::string_view title, std::string_view text, const Image& map,
                       const ColourScale& scale) {
  const std::string uri = makePngUri(encodePng(drawMap(map, scale)));
  return fmt::format(
      "<figure><figcaption><h3>{1}</h3><p>{2}</p></figcaption>"
      "<div class=\"view\" tabindex=\"0\" role=\"group\" aria-label=\"{1}: arrows move, plus and minus zoom\">"
      "<div class=\"layer\"><img class=\"picture\" id=\"{0}\" alt=\"{1} by pixel\" draggable=\"false\" src=\"{3}\"/>"
      "</div></div>{4}</figure>\n",
      id, title, text, uri, makeLegend(scale));
}

std::string makeMaps(const ReportContent& content) {
  const Image &image = content.image.pixels, &reference = content.reference.pixels;
  const Image difference = subtractLuminances(image, reference);
  return makeFigure(
             "relmse", "Squared relative error",
             "(I&#8722;R)&#178; / (R&#178; + (0.01 mean R)&#178;); its mean over the pixels that count is relmse.",
             computeRelMseMap(image, reference, content.mask), kRelMseScale) +
         makeFigure("flip", "FLIP", "How much an eye sees change; its mean over the pixels that count is flip.",
                    computeFlipMap(image, reference, content.viewing), kFlipScale) +
         makeFigure(
             "difference", "Difference of luminance",
             "Image less reference: red is too bright, blue too dark. The scale ends where 99.5 % of pixels are.",
             difference, makeDifferenceScale(difference));
}

std::string makeRow(std::string_view head, std::initializer_list<std::string> cells, std::string_view row_class = "") {
  std::string row = fmt::format("<tr{}><th scope=\"row\">{}</th>",
                                row_class.empty() ? "" : fmt::format(" class=\"{}\"", row_class), escapeHtml(head));
  for (const std::string& cell : cells) row += "<td>" + escapeHtml(cell) + "</td>";
  return row + "</tr>\n";
}

std::string makeMeans(const ReportContent& content) {
  const auto row = [](const char* name, const dvec3& v) {
    return makeRow(name, {fmt::format("{:.6g}", v.x), fmt::format("{:.6g}", v.y), fmt::format("{:.6g}", v.z)});
  };
  return row("mean", content.image_mean) + row("reference mean", content.reference_mean) +
         row("ratio", content.image_mean / content.reference_mean);
}

std::string makeFigures(const ReportContent& content) {
  std::string rows;
  for (const auto& [name, value] : content.figures)
    rows += makeRow(name, {fmt::format("{:.6g}", value), findMetric(name).text});
  return rows;
}

/// Both files' side by side, each key once.
std::string makeMetadata(const ReportContent& content) {
  const auto &image = content.image.metadata, &reference = content.reference.metadata;
  std::set<std::string> keys;
  for (const auto* metadata : {&image, &reference})
    for (const auto& [key, value] : *metadata) keys.insert(key);
  const auto find = [](const std::map<std::string, std::string>& metadata, const std::string& key) {
    const auto found = metadata.find(key);
    return found == metadata.end() ? std::string("\xe2\x80\x93") : found->second;  // an en dash
  };
  std::string rows;
  for (const std::string& key : keys) {
    const std::string a = find(image, key), b = find(reference, key);
    rows += makeRow(key, {a, b}, a == b ? "" : "differs");
  }
  return rows.empty() ? "<tr><td colspan=\"3\">None. It is read from EXR files.</td></tr>" : rows;
}

/// What the page's program needs to know; no text from files is in it.
std::string makeSettings(const ReportContent& content, const PackedPicture& image, const PackedPicture& reference) {
  const float exposure_ev = content.viewing.display_referred ? 0.0F : computeAutoExposure(content.reference.pixels);
  return nlohmann::json{{"width", content.image.pixels.width},
                        {"height", content.image.pixels.height},
                        {"imageExponent", image.exponent},
                        {"referenceExponent", reference.exponent},
                        {"exposure", std::round(4.0F * exposure_ev) / 4.0F}}
      .dump();
}

}  // namespace

std::string makeReport(const ReportContent& content) {
  const PackedPicture image = packPicture(content.image.pixels), reference = packPicture(content.reference.pixels);
  return fillTemplate(kReportPage, {{"style", kReportStyle},
                                    {"script", kReportScript},
                                    {"image", escapeHtml(content.image.name)},
                                    {"reference", escapeHtml(content.reference.name)},
                                    {"summary", escapeHtml(content.summary)},
                                    {"settings", makeSettings(content, image, reference)},
                                    {"image-uri", makePngUri(encodePng(image.bytes))},
                                    {"reference-uri", makePngUri(encodePng(reference.bytes))},
                                    {"maps", makeMaps(content)},
                                    {"histogram", drawHistogram(content.image.pixels, content.reference.pixels)},
                                    {"means", makeMeans(content)},
                                    {"figures", makeFigures(content)},
                                    {"metadata", makeMetadata(content)}});
}

}  // namespace nephroid
