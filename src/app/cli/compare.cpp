// `nephroid compare`: how far a picture is from its reference.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/cli/command.h"
#include "app/cli/comparison.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "core/file.h"
#include "metrics/report.h"

namespace nephroid::cli {
namespace {

constexpr const char* kExamples = R"(Examples:
  nephroid compare out.exr reference.exr --layer caustic
  nephroid compare out.exr truth.exr --layer direct+caustic --reference-layer beauty --mask floor.png
  nephroid compare a.png b.png --metric rmse,mape --json
  nephroid compare out.exr reference.exr --layer caustic --html report.html)";

struct OutputOptions {
  std::string html;
  bool json = false;
};

dvec3 meanRatio(const Comparison& comparison) {
  dvec3 ratio(0);
  for (int c = 0; c < 3; ++c) ratio[c] = comparison.image_mean[c] / comparison.reference_mean[c];
  return ratio;
}

const char* flipName(const Viewing& viewing) { return viewing.display_referred ? "LDR" : "HDR"; }

/// Which FLIP it is. Other metrics are the same however pictures are looked at.
std::string describeMetric(const std::string& name, const Viewing& viewing) {
  if (name != "flip") return "";
  return fmt::format("  {}, {} pixels per degree", flipName(viewing), viewing.pixels_per_degree);
}

/// Which layers, and how many of their pixels.
std::string summarise(const Comparison& comparison) {
  std::string text = fmt::format("layer {}", comparison.layer);
  if (comparison.reference_layer != comparison.layer) text += fmt::format(" against {}", comparison.reference_layer);
  text += fmt::format(", {} pixels", comparison.pixel_count);
  const NotFinitePixels& bad = comparison.not_finite;
  if (bad.in_image + bad.in_reference > 0)
    text +=
        fmt::format(", left out as not finite: {} of the image, {} of the reference", bad.in_image, bad.in_reference);
  return text;
}

std::string formatComparison(const Comparison& comparison) {
  const auto row = [](const char* name, const dvec3& v) {
    return fmt::format("{:<16} {:>12.6g} {:>12.6g} {:>12.6g}\n", name, v.x, v.y, v.z);
  };
  std::string text = summarise(comparison);
  text += fmt::format("\n{:<16} {:>12} {:>12} {:>12}\n", "", "R", "G", "B");
  text += row("mean", comparison.image_mean) + row("reference mean", comparison.reference_mean);
  text += row("ratio", meanRatio(comparison));
  for (const auto& [name, value] : comparison.values)
    text += fmt::format("{:<16} {:>12.6g}{}\n", name, value, describeMetric(name, comparison.viewing));
  return text;
}

/// What JSON cannot say, as a ratio to black, becomes null.
std::string formatComparisonJson(const CompareOptions& options, const Comparison& comparison) {
  const auto triple = [](const dvec3& v) { return std::array<double, 3>{v.x, v.y, v.z}; };
  nlohmann::ordered_json values = nlohmann::ordered_json::object();
  for (const auto& [name, value] : comparison.values) values[name] = value;
  const nlohmann::ordered_json json{
      {"image", options.image},
      {"reference", options.reference},
      {"mask", options.mask},
      {"layer", comparison.layer},
      {"reference_layer", comparison.reference_layer},
      {"pixels", comparison.pixel_count},
      {"not_finite", {{"image", comparison.not_finite.in_image}, {"reference", comparison.not_finite.in_reference}}},
      {"mean", triple(comparison.image_mean)},
      {"reference_mean", triple(comparison.reference_mean)},
      {"ratio", triple(meanRatio(comparison))},
      {"metrics", values},
      {"flip", {{"kind", flipName(comparison.viewing)}, {"pixels_per_degree", comparison.viewing.pixels_per_degree}}}};
  // Names of files need not be UTF-8, which JSON must be.
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void writeReport(const std::string& path, const CompareOptions& options, const Comparison& comparison) {
  const std::string kind = fmt::format("; flip: {}, {} pixels per degree", flipName(comparison.viewing),
                                       comparison.viewing.pixels_per_degree);
  const std::string page =
      makeReport({.image = {options.image, comparison.image, comparison.image_metadata},
                  .reference = {options.reference, comparison.reference, comparison.reference_metadata},
                  .mask = comparison.mask,
                  .viewing = comparison.viewing,
                  .summary = summarise(comparison) + kind,
                  .image_mean = comparison.image_mean,
                  .reference_mean = comparison.reference_mean,
                  .figures = comparison.values});
  writeFileAtomically(path, std::as_bytes(std::span(page)));
  writeStderr("wrote " + path);
}

ExitCode runCompare(const CompareOptions& options, const OutputOptions& output) {
  if (options.image.empty() || options.reference.empty())
    throw UsageError("compare: two pictures are needed: nephroid compare IMAGE REFERENCE");
  if (!output.html.empty()) checkWritable(output.html);
  const Comparison comparison = comparePictures(options);
  if (!output.html.empty()) writeReport(output.html, options, comparison);
  writeStdout(output.json ? formatComparisonJson(options, comparison) : formatComparison(comparison));
  return ExitCode::kDone;
}

std::string metricNames() {
  std::vector<std::string> names;
  for (const Metric& metric : metrics()) names.push_back(metric.name);
  return fmt::format("{}", fmt::join(names, "|"));
}

std::string describeMetrics() {
  std::string text = "Metrics:\n";
  for (const Metric& metric : metrics()) text += fmt::format("  {:<10} {}\n", metric.name, metric.text);
  text += "Pixels that are NaN or infinite in either picture are left out, counted and warned about.\n";
  return text + "\n" + kExamples;
}

}  // namespace

Command addCompareCommand(CLI::App& root) {
  const auto options = std::make_shared<CompareOptions>();
  const auto output = std::make_shared<OutputOptions>();
  CLI::App* app = addCommand(root, "compare", "Tell how far a picture is from its reference.", describeMetrics());
  addValue(*app, "IMAGE", options->image, "IMAGE", {"The picture: EXR, PNG, JPEG, WebP or HDR.", "", "", ""});
  addValue(*app, "REFERENCE", options->reference, "REFERENCE", {"What it should look like; same size.", "", "", ""});
  addValue(*app, "--layer", options->layer, "LAYERS",
           {"Layer of the EXR, or a sum such as direct+caustic.", "beauty, or else the first that both have", "", ""});
  addValue(*app, "--reference-layer", options->reference_layer, "LAYERS",
           {"Layer of the reference, where it has another name.", "as --layer", "", ""});
  addValue(*app, "--mask", options->mask, "FILE",
           {"A PNG of the same size; pixels of value 255 count.", "all", "", ""});
  addValue(*app, "--metric", options->metrics, "LIST", {"Metrics, separated by commas.", "all", metricNames(), ""});
  addValue(*app, "--pixels-per-degree", options->pixels_per_degree, "P",
           {"For flip: how many pixels the eye that looks at the pictures has in a degree; more are further away.",
            fmt::format("{}", kDefaultPixelsPerDegree),
            fmt::format("{} to {}", kMinPixelsPerDegree, kMaxPixelsPerDegree), "px/deg"},
           checkNumber(double{kMinPixelsPerDegree}, double{kMaxPixelsPerDegree}));
  addValue(*app, "--html", output->html, "FILE",
           {"Also writes a page to look at: both pictures under a divider, maps of the error, figures, metadata. It is "
            "one file that needs no network.",
            "none", "", ""});
  addSwitch(*app, "--json", output->json, "Print JSON.");
  return {app, [options, output] { return runCompare(*options, *output); }};
}

}  // namespace nephroid::cli
