// How far each technique is from pictures that can be worked out with pen and paper, and how `nephroid bench
// --closed-form` tells it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/technique_options.h"
#include "closed_form/forms.h"

namespace nephroid::cli {

/// One way to draw: a technique, and of the technique `reference` one of its estimators.
struct Drawer {
  const Technique* technique = nullptr;
  std::string estimator;  ///< empty: it has none

  std::string name() const;
};

/// All drawers of these techniques. Of estimators those that `parameters` names ("estimator=…"), and only techniques
/// that have estimators then; else those of `estimators`.
/// @param parameters  loses what it has of estimators
std::vector<Drawer> listDrawers(const std::vector<const Technique*>& techniques, std::vector<std::string>& parameters,
                                const std::vector<std::string>& estimators);

struct ClosedFormOptions {
  TechniqueOptions technique;                 ///< size and name have no meaning here; a parameter is for who knows it
  std::vector<std::string> frame_parameters;  ///< of techniques that draw frames, where they are not set
  std::uint64_t eye_samples = 0;              ///< per pixel, of the reference, where --samples is not given
  std::uint64_t frames = 0;                   ///< of techniques that draw frames, likewise
};

/// One figure of one form, by one drawer.
struct ClosedFormRow {
  const closed_form::ClosedForm* form = nullptr;
  const closed_form::Figure* figure = nullptr;
  Drawer drawer;
  std::optional<double> error;      ///< >= 0, in the figure's unit; nothing: no light, or nothing to measure
  std::optional<double> tolerance;  ///< nothing: no limit is set

  /// Whether the error is within its tolerance; nothing where there is none.
  std::optional<bool> holds() const;
};

/// Renders the form and measures each of its figures.
/// @throws UsageError, DeviceError, ResourceError; InterruptedError if the program was asked to stop
std::vector<ClosedFormRow> measureClosedForm(const closed_form::ClosedForm& form, const Drawer& drawer,
                                             const ClosedFormOptions& options);

/// @throws UsageError if a parameter is of none of the techniques
void checkParameters(const std::vector<std::string>& parameters, const std::vector<Drawer>& drawers);

std::string formatClosedFormHeader();
std::string formatClosedFormRow(const ClosedFormRow& row);
nlohmann::ordered_json closedFormToJson(const ClosedFormRow& row);

}  // namespace nephroid::cli
