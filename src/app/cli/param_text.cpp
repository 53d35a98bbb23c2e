#include "app/cli/param_text.h"

#include <fmt/format.h>

#include <array>

#include "app/cli/help.h"
#include "app/cli/options.h"

namespace nephroid::cli {
namespace {

bool isBounded(const ParamSpec& spec) { return spec.lower != 0 || spec.upper != 0; }

std::string describeRange(const ParamSpec& spec) {
  if (!spec.choices.empty()) return fmt::format("{}", fmt::join(spec.choices, "|"));
  if (std::holds_alternative<bool>(spec.default_value)) return "true|false";
  return isBounded(spec) ? fmt::format("{:g} to {:g}", spec.lower, spec.upper) : "";
}

nlohmann::ordered_json valueToJson(const ParamValue& value) {
  struct Visitor {
    nlohmann::ordered_json operator()(const vec3& v) const { return std::array<float, 3>{v.x, v.y, v.z}; }
    nlohmann::ordered_json operator()(bool v) const { return v; }
    nlohmann::ordered_json operator()(int v) const { return v; }
    nlohmann::ordered_json operator()(float v) const { return v; }
    nlohmann::ordered_json operator()(const std::string& v) const { return v; }
  };
  return std::visit(Visitor{}, value);
}

const char* typeName(const ParamValue& value) {
  constexpr std::array<const char*, std::variant_size_v<ParamValue>> kNames{"bool", "int", "float", "string", "vec3"};
  return kNames[value.index()];
}

}  // namespace

std::string formatParams(std::span<const ParamSpec> specs) {
  std::string text;
  for (const ParamSpec& spec : specs) {
    const std::string default_text = formatParamValue(spec.default_value);
    const std::string description =
        describe({spec.text, default_text.empty() ? "none" : default_text, describeRange(spec), spec.unit});
    text += formatEntry(spec.name, description);
  }
  return text;
}

std::string formatHeading(const std::string& name, const std::string& text, const std::string& source) {
  return wrapText(fmt::format("{} - {}{}", name, text, source.empty() ? "" : fmt::format(" ({})", source)), 0,
                  kHelpWidth);
}

nlohmann::ordered_json paramsToJson(std::span<const ParamSpec> specs) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ParamSpec& spec : specs) {
    nlohmann::ordered_json entry{{"name", spec.name},
                                 {"type", typeName(spec.default_value)},
                                 {"default", valueToJson(spec.default_value)},
                                 {"unit", spec.unit},
                                 {"text", spec.text}};
    if (isBounded(spec)) entry["range"] = {spec.lower, spec.upper};
    if (!spec.choices.empty()) entry["choices"] = spec.choices;
    list.push_back(entry);
  }
  return list;
}

}  // namespace nephroid::cli
