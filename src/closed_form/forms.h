// The list of closed forms: what is rendered, what is measured, and how exact it has to be.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "closed_form/plane_picture.h"

namespace nephroid::closed_form {

/// What an error is counted in.
enum class Unit {
  kShare,    ///< of what the formula has
  kDegrees,  ///< of angle
  kPixels,
};

/// One error of a picture against its formula.
struct Figure {
  std::string name;
  Unit unit = Unit::kShare;
  /// What the error may be at most, in `unit`: of the technique `reference`, which converges, and of those that draw
  /// frames. Nothing: no limit is set.
  std::optional<double> reference_tolerance, realtime_tolerance;
};

/// One closed form. Its formula and scene stand in the file that it is named after, with the derivation.
struct ClosedForm {
  std::string name;
  std::string text;
  std::uint64_t photons = 0;  ///< by which the reference's noise is below its tolerances
  std::vector<Figure> figures;
  /// Renders, once or several times. @return  errors, >= 0, one for each figure; not finite where there is no measure
  std::function<std::vector<double>(const PlaneRenderer& render)> compare;
};

std::span<const ClosedForm> closedForms();
/// @throws UsageError with the names there are
const ClosedForm& findClosedForm(std::string_view name);

/// The errors of what `render` draws, >= 0, one for each of the form's figures; nothing where it drew no light at all
/// or what is measured is not there.
std::vector<std::optional<double>> measureErrors(const ClosedForm& form, const PlaneRenderer& render);

/// The tolerance that bears on a technique.
std::optional<double> toleranceFor(const Figure& figure, const Technique& technique);

}  // namespace nephroid::closed_form
