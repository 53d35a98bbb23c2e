#include "techniques/layers.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/params.h"
#include "nephroid/error.h"

namespace nephroid {
namespace {

constexpr std::string_view kRadianceUnit = "W/m^2/sr", kIrradianceUnit = "W/m^2";

constexpr LayerInfo kLayers[] = {
    {"beauty", 3, false, kRadianceUnit, "the picture: the sum of direct, caustic, specular, indirect and emission"},
    {"direct", 3, true, kRadianceUnit, "light straight from a light onto what the eye sees (L D E)"},
    {"caustic", 3, true, kRadianceUnit, "light bent or mirrored onto what the eye sees (L S+ D E)"},
    {"specular", 3, true, kRadianceUnit, "everything seen in mirrors, through glass and in gloss (... S+ E)"},
    {"indirect", 3, true, kRadianceUnit,
     "light scattered diffusely at least once before what the eye sees (... D ... D E)"},
    {"emission", 3, true, kRadianceUnit, "lights and background as the eye sees them directly (L E)"},
    {"specular_caustic", 3, false, kRadianceUnit, "the part of specular that shows caustics (L S+ D S+ E)"},
    {"irradiance", 3, false, kIrradianceUnit, "light arriving at the first diffuse surface"},
    {"irradiance_caustic", 3, false, kIrradianceUnit, "the part of irradiance that is caustic"},
    {"beauty_error", 3, false, kRadianceUnit, "standard error of beauty, by the spread of its batches"},
    {"direct_error", 3, false, kRadianceUnit, "standard error of direct"},
    {"caustic_error", 3, false, kRadianceUnit, "standard error of caustic"},
    {"specular_error", 3, false, kRadianceUnit, "standard error of specular"},
    {"indirect_error", 3, false, kRadianceUnit, "standard error of indirect"},
    {"emission_error", 3, false, kRadianceUnit, "standard error of emission"},
    {"specular_caustic_error", 3, false, kRadianceUnit, "standard error of specular_caustic"},
    {"irradiance_error", 3, false, kIrradianceUnit, "standard error of irradiance"},
    {"irradiance_caustic_error", 3, false, kIrradianceUnit, "standard error of irradiance_caustic"},
    {"caustic_bias", 3, false, kRadianceUnit,
     "what the width of kernels adds to caustic (or takes, where negative), estimated from two widths"},
    {"specular_caustic_bias", 3, false, kRadianceUnit,
     "what the width of kernels adds to specular_caustic (or takes, where negative), estimated from two widths"},
    {"albedo", 3, false, "", "base colour of the first surface"},
    {"normal", 3, false, "", "shading normal of the first surface, world space"},
    {"position", 3, false, "m", "place on the first surface, world space"},
    {"depth", 1, false, "m", "distance of the first surface along the viewing axis; infinite where there is none"},
    {"id", 1, false, "", "number of the first surface's instance, counted from 1; 0 where there is none"},
};

}  // namespace

std::span<const LayerInfo> layerInfos() { return kLayers; }

std::string_view erringLayer(std::string_view name) {
  constexpr std::string_view kSuffix = "_error";
  return name.ends_with(kSuffix) ? name.substr(0, name.size() - kSuffix.size()) : std::string_view();
}

bool isEstimate(std::string_view name) { return !erringLayer(name).empty() || name.ends_with("_bias"); }

const LayerInfo& findLayerInfo(std::string_view name) {
  std::vector<std::string> names;
  for (const LayerInfo& info : kLayers) {
    if (info.name == name) return info;
    names.emplace_back(info.name);
  }
  const std::string near = suggestName(name, names);
  throw UsageError(fmt::format("no layer '{}'{}; there are: {}", name,
                               near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near), fmt::join(names, ", ")));
}

std::vector<std::string> parseLayerList(std::string_view comma_separated) {
  std::vector<bool> wanted(std::size(kLayers), false);
  while (true) {
    const std::size_t comma = comma_separated.find(',');
    wanted[static_cast<std::size_t>(&findLayerInfo(comma_separated.substr(0, comma)) - kLayers)] = true;
    if (comma == std::string_view::npos) break;
    comma_separated.remove_prefix(comma + 1);
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (wanted[i]) names.emplace_back(kLayers[i].name);
  return names;
}

}  // namespace nephroid
