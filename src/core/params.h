// A parameter is declared once: name, type, default, range, unit, sentence. From that one entry come `--set` and
// `?key=value`, `nephroid techniques` and `nephroid scenes`, the metadata, and the check of its range.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/math.h"

namespace nephroid {

using ParamValue = std::variant<bool, int, float, std::string, vec3>;

/// One declaration. `default_value` fixes the type.
struct ParamSpec {
  std::string name;
  ParamValue default_value;
  double lower = 0.0, upper = 0.0;   ///< inclusive range of int, float and each vec3 component; both 0: unbounded
  std::string unit;                  ///< "m", "W/m^2", "deg", or "" for a pure number
  std::string text;                  ///< one sentence
  std::vector<std::string> choices;  ///< allowed values of a string; empty: any
};

/// Values for a list of declarations, defaults until set.
class ParamSet {
 public:
  ParamSet() = default;
  explicit ParamSet(std::vector<ParamSpec> specs);

  /// Parses and checks `text` ("0.5", "true", "1,0.5,0.2" or "#rrggbb" for vec3).
  /// @throws UsageError naming the parameter, what was given, its range or choices, and the nearest known name
  void set(std::string_view name, std::string_view text);
  bool has(std::string_view name) const;
  /// True once `set` was called for it.
  bool isSet(std::string_view name) const;

  bool getBool(std::string_view name) const;
  int getInt(std::string_view name) const;
  float getFloat(std::string_view name) const;
  const std::string& getString(std::string_view name) const;
  vec3 getVec3(std::string_view name) const;

  std::span<const ParamSpec> specs() const { return specs_; }
  /// The current value as text that `set` takes back.
  std::string toText(std::string_view name) const;

 private:
  std::size_t find(std::string_view name) const;

  std::vector<ParamSpec> specs_;
  std::vector<ParamValue> values_;
  std::vector<bool> set_;
};

/// A value as text that `ParamSet::set` takes back.
std::string formatParamValue(const ParamValue& value);

/// "key=value" pairs separated by `separator`; a value may hold commas when the separator is ',' only if what follows
/// the comma is not itself "key=" ("eye=1,2,3:fov=40", "ior=1.5,attenuation=0.1,0.2,0.3").
/// @throws UsageError on a piece without '='
std::vector<std::pair<std::string, std::string>> parseKeyValues(std::string_view text, char separator);

/// The candidate with the smallest edit distance to `name`, if it is close enough to be a likely slip; else "".
std::string suggestName(std::string_view name, std::span<const std::string> candidates);

}  // namespace nephroid
