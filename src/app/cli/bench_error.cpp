#include "app/cli/bench_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/cli/progress_bar.h"
#include "app/cli/scene_options.h"
#include "app/cli/stop.h"
#include "metrics/metrics.h"
#include "nephroid/error.h"
#include "scene/edit.h"

namespace nephroid::cli {
namespace {

/// What `caustic` is compared by: the layer that a technique for caustics is judged on.
constexpr const char* kLayer = "caustic";

/// @throws InterruptedError if the program was asked to stop: half a render would be a wrong figure
RenderResult renderCaustic(const SceneData& scene, const Technique& technique, RenderSettings settings,
                           const std::string& title) {
  settings.layers = {kLayer};
  settings.ledgers = true;
  ProgressBar bar(title);
  RenderResult result = technique.render(scene, selectCamera(scene, "0"), settings, &bar, &stopToken());
  if (stopToken().requested()) throw InterruptedError("interrupted: the figures so far are complete");
  return result;
}

/// What `--set`, `--device` and the budget say is for the techniques that are compared.
RenderSettings makeReferenceSettings(const ErrorOptions& options, std::uint64_t half) {
  TechniqueOptions reference;
  reference.name = "reference";
  reference.size = options.technique.size;
  reference.threads = options.technique.threads;
  reference.photons = options.reference_photons / 2;
  reference.parameters = {"estimator=light"};          // the one without bias
  reference.seed = options.technique.seed + 1 + half;  // neither those of the other half nor of what is compared
  return makeSettings(reference);
}

Image meanOf(const Image& a, const Image& b) {
  Image mean = a;
  for (std::size_t i = 0; i < mean.pixels.size(); ++i) mean.pixels[i] = 0.5F * (a.pixels[i] + b.pixels[i]);
  return mean;
}

double sumOf(const Image& image) {
  double sum = 0;
  for (const float value : image.pixels) sum += double{value};
  return sum;
}

double relativeLuminance(const dvec3& flux) { return dot(flux, dvec3(0.2126, 0.7152, 0.0722)); }

/// Adds up the lights.
void addLostShares(ErrorResult& result, const std::vector<Ledger>& ledgers) {
  if (ledgers.empty()) return;
  Ledger sum;
  for (const Ledger& ledger : ledgers) sum.add(ledger);
  const double met = relativeLuminance(sum.emitted - sum.missed - sum.blocked);
  const auto share = [met](const dvec3& flux) { return met > 0 ? relativeLuminance(flux) / met : 0.0; };
  result.lost = std::max(share(sum.lostTotal()), 0.0);  // below 0 it is rounding
  for (std::size_t i = 0; i < sum.lost.size(); ++i)
    if (const double lost = share(sum.lost[i]); lost > 0)
      result.lost_by_reason.push_back({std::string(lossReasonName(static_cast<LossReason>(i))), lost});
}

ErrorResult compareCaustics(const Image& caustic, const Image& reference) {
  ErrorResult result;
  result.relmse = findMetric("relmse").compute(caustic, reference, {}, {});
  result.flip = findMetric("flip").compute(caustic, reference, {}, {});
  result.energy = sumOf(caustic) / sumOf(reference);
  return result;
}

std::size_t sceneWidth(const std::vector<std::string>& scenes) {
  std::size_t width = 0;
  for (const std::string& scene : scenes) width = std::max(width, scene.size());
  return width;
}

std::string formatFields(const std::vector<std::string>& scenes, std::string_view scene, std::string_view technique,
                         std::string_view relmse, std::string_view flip, std::string_view energy,
                         std::string_view lost) {
  return fmt::format("{:<{}}  {:<13} {:>9} {:>8} {:>8} {:>9}\n", scene, sceneWidth(scenes), technique, relmse, flip,
                     energy, lost);
}

}  // namespace

CausticReference renderCausticReference(const std::string& scene, const ErrorOptions& options) {
  CausticReference reference;
  reference.scene = loadEditedScene({.scene = scene}, 0.0F);
  RenderResult halves[2];
  for (std::uint64_t i = 0; i < 2; ++i)
    halves[i] = renderCaustic(reference.scene, findTechnique("reference"), makeReferenceSettings(options, i),
                              fmt::format("{} reference {}/2", scene, i + 1));
  reference.half = *halves[0].image.find(kLayer);
  reference.caustic = meanOf(reference.half, *halves[1].image.find(kLayer));
  reference.ledgers = std::move(halves[0].ledgers);
  return reference;
}

ErrorResult measureNoise(const std::string& scene, const CausticReference& reference) {
  ErrorResult result = compareCaustics(reference.half, reference.caustic);
  result.scene = scene;
  result.technique = "reference/2";
  result.device = "cpu";
  addLostShares(result, reference.ledgers);
  return result;
}

ErrorResult measureError(const std::string& scene, const Technique& technique, const CausticReference& reference,
                         const ErrorOptions& options) {
  TechniqueOptions technique_options = options.technique;
  technique_options.name = technique.name;
  const RenderResult rendered =
      renderCaustic(reference.scene, technique, makeSettings(technique_options), scene + " " + technique.name);
  ErrorResult result = compareCaustics(*rendered.image.find(kLayer), reference.caustic);
  result.scene = scene;
  result.technique = technique.name;
  result.device = rendered.image.metadata.at("device");
  addLostShares(result, rendered.ledgers);
  return result;
}

std::string formatErrorHeader(const std::vector<std::string>& scenes, const ErrorOptions& options) {
  const Size& size = options.technique.size;
  return fmt::format(
             "caustic at {}x{} against the reference's of {:.4g} M photons\n"
             "  reference/2  half of those photons against all: what noise alone makes of each figure\n"
             "  FLIP         HDR-FLIP at {} pixels per degree\n"
             "  energy       sum over the picture, over the reference's\n"
             "  lost         of the flux that meets what bends light, what the ledger has as lost\n\n",
             size.width, size.height, 1e-6 * static_cast<double>(options.reference_photons), kDefaultPixelsPerDegree) +
         formatFields(scenes, "scene", "technique", "relMSE", "FLIP", "energy", "lost");
}

std::string formatErrorRow(const std::vector<std::string>& scenes, const ErrorResult& result) {
  return formatFields(scenes, result.scene, result.technique, fmt::format("{:.3g}", result.relmse),
                      fmt::format("{:.4f}", result.flip),
                      std::isfinite(result.energy) ? fmt::format("{:.3f}", result.energy) : "-",
                      result.lost ? fmt::format("{:.2f} %", 100 * *result.lost) : "-");
}

nlohmann::ordered_json errorToJson(const ErrorResult& result) {
  nlohmann::ordered_json by_reason = nlohmann::ordered_json::object();
  for (const LostShare& lost : result.lost_by_reason) by_reason[lost.reason] = lost.share;
  nlohmann::ordered_json json{{"scene", result.scene},   {"technique", result.technique}, {"device", result.device},
                              {"relmse", result.relmse}, {"flip", result.flip},           {"energy", result.energy},
                              {"lost", nullptr},         {"lost_by_reason", by_reason}};
  if (result.lost) json["lost"] = *result.lost;
  return json;
}

}  // namespace nephroid::cli
