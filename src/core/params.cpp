#include "core/params.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <system_error>
#include <utility>

#include "core/image/tonemap.h"
#include "nephroid/error.h"

namespace nephroid {
namespace {

bool isBounded(const ParamSpec& spec) { return spec.lower != 0.0 || spec.upper != 0.0; }

bool isInRange(const ParamSpec& spec, double value) {
  return !isBounded(spec) || (value >= spec.lower && value <= spec.upper);
}

std::string describeRange(const ParamSpec& spec) {
  return isBounded(spec) ? fmt::format(" in [{}, {}]", spec.lower, spec.upper) : std::string();
}

std::string describeExpected(const ParamSpec& spec) {
  const std::string unit = spec.unit.empty() ? "" : " " + spec.unit;
  if (std::holds_alternative<bool>(spec.default_value)) return "true or false";
  if (std::holds_alternative<int>(spec.default_value)) return "a whole number" + describeRange(spec) + unit;
  if (std::holds_alternative<float>(spec.default_value)) return "a number" + describeRange(spec) + unit;
  if (std::holds_alternative<vec3>(spec.default_value))
    return "three numbers x,y,z" + describeRange(spec) + unit + ", or #rrggbb";
  return fmt::format("one of {}", fmt::join(spec.choices, ", "));
}

/// The whole of `text` as a number, in the C locale's notation; no blanks, no '+', no rest.
template <class T>
std::optional<T> parseWhole(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<bool> parseBool(std::string_view text) {
  if (text == "true" || text == "on" || text == "yes" || text == "1") return true;
  if (text == "false" || text == "off" || text == "no" || text == "0") return false;
  return std::nullopt;
}

/// A float within the range of `spec`. The range is checked on the double that was written, so that "0.1" passes an
/// upper bound of 0.1 although the nearest float lies above. Infinity passes only where the range names it.
std::optional<float> parseFloat(const ParamSpec& spec, std::string_view text) {
  const std::optional<double> exact = parseWhole<double>(text);
  if (!exact || std::isnan(*exact) || !isInRange(spec, *exact)) return std::nullopt;
  if (std::isinf(*exact) && !isBounded(spec)) return std::nullopt;
  // Direct conversion rounds once; through double it would round twice and could miss the float that was printed.
  if (const std::optional<float> value = parseWhole<float>(text)) return value;
  const auto tiny = static_cast<float>(*exact);
  return std::abs(*exact) < 1.0 ? std::optional(tiny) : std::nullopt;  // underflow is 0, overflow an error
}

std::optional<vec3> parseHexColour(const ParamSpec& spec, std::string_view text) {
  if (text.size() != 7) return std::nullopt;
  vec3 colour(0.0F);
  for (int c = 0; c < 3; ++c) {
    const std::string_view digits = text.substr(1 + 2 * static_cast<std::size_t>(c), 2);
    int byte = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
    if (error != std::errc() || end != digits.data() + digits.size() || byte < 0) return std::nullopt;
    colour[c] = linearFromSrgb(static_cast<float>(byte) / 255.0F);
    if (!isInRange(spec, colour[c])) return std::nullopt;
  }
  return colour;
}

std::optional<vec3> parseVec3(const ParamSpec& spec, std::string_view text) {
  if (text.starts_with('#')) return parseHexColour(spec, text);
  vec3 value;
  for (int c = 0; c < 3; ++c) {
    const std::size_t comma = text.find(',');
    if ((comma == std::string_view::npos) != (c == 2)) return std::nullopt;
    const std::optional<float> component = parseFloat(spec, text.substr(0, comma));
    if (!component) return std::nullopt;
    value[c] = *component;
    text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
  }
  return value;
}

std::optional<std::string> parseString(const ParamSpec& spec, std::string_view text) {
  const bool allowed = spec.choices.empty() || std::ranges::find(spec.choices, text) != spec.choices.end();
  return allowed ? std::optional<std::string>(text) : std::nullopt;
}

std::optional<ParamValue> parseValue(const ParamSpec& spec, std::string_view text) {
  const auto wrap = [](auto parsed) { return parsed ? std::optional<ParamValue>(*std::move(parsed)) : std::nullopt; };
  if (std::holds_alternative<bool>(spec.default_value)) return wrap(parseBool(text));
  if (std::holds_alternative<float>(spec.default_value)) return wrap(parseFloat(spec, text));
  if (std::holds_alternative<vec3>(spec.default_value)) return wrap(parseVec3(spec, text));
  if (std::holds_alternative<std::string>(spec.default_value)) return wrap(parseString(spec, text));
  const std::optional<int> whole = parseWhole<int>(text);
  return whole && isInRange(spec, *whole) ? wrap(whole) : std::nullopt;
}

[[noreturn]] void failUnknown(std::string_view name, std::span<const ParamSpec> specs) {
  std::vector<std::string> names;
  for (const ParamSpec& spec : specs) names.push_back(spec.name);
  if (names.empty()) throw UsageError(fmt::format("unknown parameter '{}': there are none to set here", name));
  const std::string nearest = suggestName(name, names);
  const std::string hint = nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
  throw UsageError(fmt::format("unknown parameter '{}'{} (known: {})", name, hint, fmt::join(names, ", ")));
}

/// Where parameter `name` is read as `T`: the names are ours, so an unknown one is our mistake.
template <class T>
const T& getValue(std::span<const ParamSpec> specs, std::span<const ParamValue> values, std::string_view name) {
  const auto found = std::ranges::find(specs, name, &ParamSpec::name);
  if (found == specs.end()) throw InternalError(fmt::format("parameter '{}' is read but was not declared", name));
  const T* value = std::get_if<T>(&values[static_cast<std::size_t>(found - specs.begin())]);
  if (value == nullptr) throw InternalError(fmt::format("parameter '{}' is read as another type than declared", name));
  return *value;
}

bool isKeyStart(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool isKeyCharacter(char c) { return isKeyStart(c) || (c >= '0' && c <= '9') || c == '-' || c == '.'; }

/// Whether `piece` begins with "key=".
bool beginsWithKey(std::string_view piece) {
  const std::size_t equals = piece.find('=');
  return equals != std::string_view::npos && equals > 0 && isKeyStart(piece.front()) &&
         std::ranges::all_of(piece.substr(0, equals), isKeyCharacter);
}

char toLower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b`, case ignored
/// (optimal string alignment: the common slips of a typist cost one each).
int computeEditDistance(std::string_view a, std::string_view b) {
  std::vector<int> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool equal = toLower(a[i - 1]) == toLower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (equal ? 0 : 1)});
      const bool swapped =
          i > 1 && j > 1 && toLower(a[i - 1]) == toLower(b[j - 2]) && toLower(a[i - 2]) == toLower(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    std::swap(before_last, last);
    std::swap(last, row);
  }
  return last.back();
}

}  // namespace

ParamSet::ParamSet(std::vector<ParamSpec> specs) : specs_(std::move(specs)), set_(specs_.size(), false) {
  values_.reserve(specs_.size());
  for (const ParamSpec& spec : specs_) values_.push_back(spec.default_value);
}

void ParamSet::set(std::string_view name, std::string_view text) {
  const std::size_t index = find(name);
  const ParamSpec& spec = specs_[index];
  std::optional<ParamValue> value = parseValue(spec, text);
  if (!value) {
    const std::string nearest = suggestName(text, spec.choices);
    const std::string hint = nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
    throw UsageError(fmt::format("{}={}: expected {}{}", name, text, describeExpected(spec), hint));
  }
  values_[index] = *std::move(value);
  set_[index] = true;
}

bool ParamSet::has(std::string_view name) const {
  return std::ranges::find(specs_, name, &ParamSpec::name) != specs_.end();
}

bool ParamSet::isSet(std::string_view name) const { return set_[find(name)]; }

bool ParamSet::getBool(std::string_view name) const { return getValue<bool>(specs_, values_, name); }
int ParamSet::getInt(std::string_view name) const { return getValue<int>(specs_, values_, name); }
float ParamSet::getFloat(std::string_view name) const { return getValue<float>(specs_, values_, name); }
const std::string& ParamSet::getString(std::string_view name) const {
  return getValue<std::string>(specs_, values_, name);
}
vec3 ParamSet::getVec3(std::string_view name) const { return getValue<vec3>(specs_, values_, name); }

std::string ParamSet::toText(std::string_view name) const { return formatParamValue(values_[find(name)]); }

std::size_t ParamSet::find(std::string_view name) const {
  const auto found = std::ranges::find(specs_, name, &ParamSpec::name);
  if (found == specs_.end()) failUnknown(name, specs_);
  return static_cast<std::size_t>(found - specs_.begin());
}

std::string formatParamValue(const ParamValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const vec3* v = std::get_if<vec3>(&value)) return fmt::format("{},{},{}", v->x, v->y, v->z);
  if (const int* whole = std::get_if<int>(&value)) return fmt::format("{}", *whole);
  if (const float* number = std::get_if<float>(&value)) return fmt::format("{}", *number);
  return std::get<std::string>(value);
}

std::vector<std::pair<std::string, std::string>> parseKeyValues(std::string_view text, char separator) {
  std::vector<std::pair<std::string, std::string>> pairs;
  while (!text.empty()) {
    const std::size_t end = text.find(separator);
    const std::string_view piece = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (beginsWithKey(piece)) {
      const std::size_t equals = piece.find('=');
      pairs.emplace_back(piece.substr(0, equals), piece.substr(equals + 1));
    } else if (separator == ',' && !pairs.empty() && !piece.empty()) {
      pairs.back().second.append(1, ',').append(piece);
    } else {
      throw UsageError(fmt::format("'{}': expected key=value, separated by '{}'", piece, separator));
    }
  }
  return pairs;
}

std::string suggestName(std::string_view name, std::span<const std::string> candidates) {
  constexpr std::size_t kMinPrefix = 3;  // a shorter beginning fits by chance
  constexpr std::size_t kMaxSlips = 3;
  std::string_view best;
  std::size_t best_distance = kMaxSlips + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t longer = std::max(name.size(), candidate.size());
    const std::size_t shorter = std::min(name.size(), candidate.size());
    const bool is_prefix = name.size() >= kMinPrefix && candidate.starts_with(name);
    if (longer - shorter > kMaxSlips && !is_prefix) continue;
    // One slip in a name of two to five letters, two from six on, three from ten on; a beginning counts as one.
    const std::size_t allowed = std::min((longer + 2) / 4, kMaxSlips);
    const auto distance = is_prefix ? std::size_t{1} : static_cast<std::size_t>(computeEditDistance(name, candidate));
    if (distance < best_distance && (is_prefix || distance <= allowed)) {
      best = candidate;
      best_distance = distance;
    }
  }
  return std::string(best);
}

}  // namespace nephroid
