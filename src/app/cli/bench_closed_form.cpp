#include "app/cli/bench_closed_form.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/cli/progress_bar.h"
#include "app/cli/stop.h"
#include "nephroid/error.h"

namespace nephroid::cli {
namespace {

using closed_form::ClosedForm;
using closed_form::PlanePicture;
using closed_form::PlaneView;
using closed_form::Unit;

constexpr std::string_view kEstimator = "estimator=";

/// The parameter that "key=value" is of; nothing if the technique has none of that name.
const ParamSpec* findParameter(const Technique& technique, std::string_view key_value) {
  const std::string_view key = key_value.substr(0, key_value.find('='));
  const auto found = std::find_if(technique.params.begin(), technique.params.end(),
                                  [&](const ParamSpec& spec) { return spec.name == key; });
  return found == technique.params.end() ? nullptr : &*found;
}

/// Those that the technique knows.
std::vector<std::string> parametersOf(const Technique& technique, const std::vector<std::string>& parameters) {
  std::vector<std::string> known;
  for (const std::string& parameter : parameters)
    if (findParameter(technique, parameter) != nullptr) known.push_back(parameter);
  return known;
}

RenderSettings makeDrawerSettings(const ClosedForm& form, const Drawer& drawer, const ClosedFormOptions& options) {
  const Technique& technique = *drawer.technique;
  const bool draws_frames = technique.make_realtime != nullptr;
  TechniqueOptions given = options.technique;
  given.name = technique.name;
  // Later values of a parameter replace earlier ones, so what the command line says comes last.
  given.parameters = draws_frames ? parametersOf(technique, options.frame_parameters) : std::vector<std::string>{};
  for (const std::string& parameter : parametersOf(technique, options.technique.parameters))
    given.parameters.push_back(parameter);
  if (!drawer.estimator.empty()) given.parameters.push_back(std::string(kEstimator) + drawer.estimator);
  if (given.samples == 0) given.samples = draws_frames ? options.frames : options.eye_samples;
  if (given.photons == 0 && !draws_frames) given.photons = form.photons;
  return makeSettings(given);
}

std::string_view symbolOf(Unit unit) {
  switch (unit) {
    case Unit::kShare:
      return "%";
    case Unit::kDegrees:
      return "°";
    case Unit::kPixels:
      return "px";
  }
  return "";
}

std::string_view nameOf(Unit unit) {
  switch (unit) {
    case Unit::kShare:
      return "share";
    case Unit::kDegrees:
      return "degrees";
    case Unit::kPixels:
      return "pixels";
  }
  return "";
}

std::string formatValue(double value, Unit unit) {
  const double shown = unit == Unit::kShare ? 100.0 * value : value;
  // Two digits, but no power of ten for what is far off.
  return shown < 99.5 ? fmt::format("{:.2g} {}", shown, symbolOf(unit))
                      : fmt::format("{:.0f} {}", shown, symbolOf(unit));
}

std::string formatFields(std::string_view form, std::string_view figure, std::string_view drawer,
                         std::string_view error, std::string_view tolerance, std::string_view holds) {
  return fmt::format("{:<16} {:<10} {:<21} {:>10} {:>10}  {}\n", form, figure, drawer, error, tolerance, holds);
}

}  // namespace

std::string Drawer::name() const { return estimator.empty() ? technique->name : technique->name + " " + estimator; }

std::vector<Drawer> listDrawers(const std::vector<const Technique*>& techniques, std::vector<std::string>& parameters,
                                const std::vector<std::string>& estimators) {
  std::vector<std::string> named;
  std::erase_if(parameters, [&](const std::string& parameter) {
    if (!parameter.starts_with(kEstimator)) return false;
    named.push_back(parameter.substr(kEstimator.size()));
    return true;
  });
  std::vector<Drawer> drawers;
  for (const Technique* technique : techniques) {
    if (findParameter(*technique, kEstimator) != nullptr)
      for (const std::string& estimator : named.empty() ? estimators : named) drawers.push_back({technique, estimator});
    else if (named.empty())
      drawers.push_back({technique, ""});
  }
  return drawers;
}

void checkParameters(const std::vector<std::string>& parameters, const std::vector<Drawer>& drawers) {
  for (const std::string& parameter : parameters) {
    const bool known = std::any_of(drawers.begin(), drawers.end(), [&](const Drawer& drawer) {
      return findParameter(*drawer.technique, parameter) != nullptr;
    });
    if (parameter.find('=') == std::string::npos || !known)
      throw UsageError(
          fmt::format("--set {}: no technique that draws the closed forms has this parameter; 'nephroid techniques' "
                      "lists them as KEY=VALUE",
                      parameter));
  }
}

std::optional<bool> ClosedFormRow::holds() const {
  if (!tolerance) return std::nullopt;
  return error && *error <= *tolerance;
}

std::vector<ClosedFormRow> measureClosedForm(const ClosedForm& form, const Drawer& drawer,
                                             const ClosedFormOptions& options) {
  closed_form::PlaneRender render;
  render.technique = drawer.technique->name;
  render.settings = makeDrawerSettings(form, drawer, options);
  render.stop = &stopToken();
  const std::vector<std::optional<double>> errors = closed_form::measureErrors(
      form, [&](const SceneData& scene, const PlaneView& view, const std::vector<std::string>& parameters) {
        ProgressBar bar(form.name + " " + drawer.name());
        render.progress = &bar;
        render.parameters = parameters;
        PlanePicture picture = renderPlane(scene, view, render);
        // Half a render would be a wrong figure.
        if (stopToken().requested()) throw InterruptedError("interrupted: the figures so far are complete");
        return picture;
      });
  std::vector<ClosedFormRow> rows;
  for (std::size_t i = 0; i < errors.size(); ++i)
    rows.push_back({&form, &form.figures[i], drawer, errors[i], toleranceFor(form.figures[i], *drawer.technique)});
  return rows;
}

std::string formatClosedFormHeader() {
  return "pictures against their formulas; nephroid's docs/closed_forms.md tells what each figure is\n"
         "  error      - where no light is drawn, or nothing to measure\n"
         "  tolerance  - where none is set\n\n" +
         formatFields("closed form", "figure", "technique", "error", "tolerance", "holds");
}

std::string formatClosedFormRow(const ClosedFormRow& row) {
  const Unit unit = row.figure->unit;
  const std::optional<bool> holds = row.holds();
  return formatFields(row.form->name, row.figure->name, row.drawer.name(),
                      row.error ? formatValue(*row.error, unit) : "-",
                      row.tolerance ? formatValue(*row.tolerance, unit) : "-",
                      !holds   ? "-"
                      : *holds ? "yes"
                               : "NO");
}

nlohmann::ordered_json closedFormToJson(const ClosedFormRow& row) {
  const auto orNull = [](const auto& value) { return value ? nlohmann::ordered_json(*value) : nullptr; };
  return {{"closed_form", row.form->name},
          {"text", row.form->text},
          {"figure", row.figure->name},
          {"unit", nameOf(row.figure->unit)},
          {"technique", row.drawer.technique->name},
          {"estimator",
           row.drawer.estimator.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(row.drawer.estimator)},
          {"error", orNull(row.error)},
          {"tolerance", orNull(row.tolerance)},
          {"holds", orNull(row.holds())}};
}

}  // namespace nephroid::cli
