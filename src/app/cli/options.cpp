#include "app/cli/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/cli/command.h"
#include "core/file.h"
#include "core/params.h"
#include "nephroid/error.h"

namespace nephroid::cli {
namespace {

/// All of `text` as a finite number.
bool parseNumber(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
}

std::string joinList(const std::vector<std::string>& items, const char* separator) {
  return fmt::format("{}", fmt::join(items, separator));
}

/// A JSON scalar as the command line would write it.
std::string toArgument(const nlohmann::json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::vector<std::string> toArguments(const nlohmann::json& value) {
  std::vector<std::string> arguments;
  if (value.is_array())
    for (const auto& item : value) arguments.push_back(toArgument(item));
  else if (value.is_object())
    for (const auto& [key, item] : value.items()) arguments.push_back(key + "=" + toArgument(item));
  else
    arguments.push_back(toArgument(value));
  return arguments;
}

std::vector<std::string> longNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  return names;
}

void applyStateEntry(CLI::App& app, const std::string& path, const std::string& key, const nlohmann::json& value) {
  CLI::Option* option = app.get_option_no_throw(key == "scene" ? "SCENE" : "--" + key);
  if (option == nullptr || key == "help" || key == "state") {
    const std::string near = suggestName(key, longNames(app));
    throw InputError(fmt::format("{}: key \"{}\" is no option of '{}'{}", path, key, app.get_name(),
                                 near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
  }
  if (option->count() > 0) return;
  if (value.is_boolean() && option->get_expected_min() == 0 && !value.get<bool>()) return;
  try {
    option->add_result(toArguments(value));
    option->run_callback();
  } catch (const CLI::Error& error) {
    throw InputError(fmt::format("{}: key \"{}\": {}", path, key, error.what()));
  } catch (const UsageError& error) {
    throw InputError(fmt::format("{}: key \"{}\": {}", path, key, error.what()));
  }
}

}  // namespace

std::string describe(const OptionText& text) {
  std::vector<std::string> facts;
  if (!text.default_value.empty()) facts.push_back("default: " + text.default_value);
  if (!text.range.empty()) facts.push_back("range: " + text.range);
  if (!text.unit.empty()) facts.push_back("unit: " + text.unit);
  return facts.empty() ? text.text : fmt::format("{} [{}]", text.text, joinList(facts, "; "));
}

Check checkNumber(double lower, double upper) {
  return [lower, upper](const std::string& text) {
    double value = 0;
    if (parseNumber(text, value) && value >= lower && value <= upper) return std::string();
    return fmt::format("'{}' is not a number from {} to {}", text, lower, upper);
  };
}

Check checkChoice(std::vector<std::string> choices) {
  return [choices = std::move(choices)](const std::string& text) {
    if (std::ranges::find(choices, text) != choices.end()) return std::string();
    const std::string near = suggestName(text, choices);
    return fmt::format("'{}' is not one of {}{}", text, joinList(choices, ", "),
                       near.empty() ? "" : fmt::format("; did you mean '{}'?", near));
  };
}

CLI::App* addCommand(CLI::App& root, const std::string& name, const std::string& description,
                     const std::string& footer) {
  CLI::App* app = root.add_subcommand(name, description);
  if (!footer.empty()) app->footer(footer);
  return app;
}

void beginGroup(CLI::App& app, const char* name) { app.option_defaults()->group(name); }

void endGroup(CLI::App& app) { beginGroup(app, "Options"); }

template <class T>
void addValue(CLI::App& app, const std::string& flags, T& target, const std::string& value_name, const OptionText& text,
              const Check& check) {
  CLI::Option* option = app.add_option(flags, target, describe(text))->type_name(value_name);
  if (check) option->check(check);
}

template void addValue(CLI::App&, const std::string&, std::string&, const std::string&, const OptionText&,
                       const Check&);
template void addValue(CLI::App&, const std::string&, int&, const std::string&, const OptionText&, const Check&);
template void addValue(CLI::App&, const std::string&, float&, const std::string&, const OptionText&, const Check&);
template void addValue(CLI::App&, const std::string&, double&, const std::string&, const OptionText&, const Check&);
template void addValue(CLI::App&, const std::string&, std::optional<float>&, const std::string&, const OptionText&,
                       const Check&);

void addParsed(CLI::App& app, const std::string& flags, const std::function<void(const std::string&)>& parse,
               const std::string& value_name, const OptionText& text) {
  app.add_option_function<std::string>(flags, parse, describe(text))->type_name(value_name);
}

void addList(CLI::App& app, const std::string& flags, std::vector<std::string>& target, const std::string& value_name,
             const OptionText& text) {
  // Without this, a repeated option would swallow the positional argument that follows it.
  app.add_option(flags, target, describe(text) + " May be repeated.")->type_name(value_name)->allow_extra_args(false);
}

void addArguments(CLI::App& app, const std::string& name, std::vector<std::string>& target,
                  const std::string& value_name, const OptionText& text) {
  app.add_option(name, target, describe(text))->type_name(value_name);
}

void addSwitch(CLI::App& app, const std::string& flags, bool& target, const std::string& text) {
  app.add_flag(flags, target, text);
}

void addCount(CLI::App& app, const std::string& flags, std::uint64_t& target, const OptionText& text) {
  const std::string name = flags.substr(flags.find("--"));
  addParsed(
      app, flags, [&target, name](const std::string& value) { target = parseCount(name, value); }, "N", text);
}

bool isGiven(const CLI::App& app, const std::string& name) { return app.count(name) > 0; }

std::uint64_t parseCount(std::string_view name, const std::string& text) {
  // Every whole number up to here is exact in the double that "1e6" and "2.5M" are read as.
  constexpr double kMaxCount = 9007199254740992.0;
  std::string_view digits = text;
  double scale = 1;
  if (!digits.empty()) {
    const char suffix = digits.back();
    if (suffix == 'k' || suffix == 'K') scale = 1e3;
    if (suffix == 'M') scale = 1e6;
    if (suffix == 'G') scale = 1e9;
    if (scale != 1) digits.remove_suffix(1);
  }
  double value = 0;
  const bool ok = parseNumber(digits, value);
  value *= scale;
  if (!ok || value < 0 || value > kMaxCount || value != std::floor(value))
    throw UsageError(fmt::format("{}: '{}' is not a count; write 64, 1e6, 500k or 2M", name, text));
  return static_cast<std::uint64_t>(value);
}

Size parseSize(std::string_view name, const std::string& text) {
  Size size;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  bool ok = width.ec == std::errc{} && width.ptr != end && (*width.ptr == 'x' || *width.ptr == 'X');
  if (ok) {
    const auto height = std::from_chars(width.ptr + 1, end, size.height);
    ok = height.ec == std::errc{} && height.ptr == end;
  }
  if (!ok) throw UsageError(fmt::format("{}: '{}' is not a size; write WIDTHxHEIGHT, such as 1024x768", name, text));
  if (size.width < 1 || size.height < 1 || size.width > kMaxSide || size.height > kMaxSide)
    throw UsageError(fmt::format("{}: '{}' is out of range; each side is 1 to {} px", name, text, kMaxSide));
  return size;
}

std::vector<std::string> splitList(std::string_view text, char separator) {
  std::vector<std::string> pieces;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    if (end > 0) pieces.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return pieces;
}

void applyStateFile(CLI::App& app, const std::string& path) {
  constexpr std::uint64_t kMaxStateBytes = 1 << 24;  // options, not data: anything larger is the wrong file
  const std::vector<std::byte> bytes = readFile(path, kMaxStateBytes);
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  nlohmann::json state;
  try {
    state = nlohmann::json::parse(text, text + bytes.size());
  } catch (const nlohmann::json::parse_error& error) {
    throw InputError(
        fmt::format("{}: byte {}: not valid JSON; expected an object such as {{\"samples\": 64}}", path, error.byte));
  }
  if (!state.is_object())
    throw InputError(
        fmt::format("{}: found a JSON {}; expected an object such as {{\"samples\": 64}}", path, state.type_name()));
  for (const auto& [key, value] : state.items()) applyStateEntry(app, path, key, value);
}

}  // namespace nephroid::cli
