#include "scene/builtin/builtin.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "nephroid/error.h"
#include "scene/builtin/scenes.h"

namespace nephroid {
namespace {

std::string listNames() {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtinScenes()) names.push_back(scene.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

const BuiltinScene& findScene(std::string_view name) {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtinScenes()) {
    if (scene.name == name) return scene;
    names.push_back(scene.name);
  }
  const std::string guess = suggestName(name, names);
  throw UsageError(fmt::format("builtin:{}: there is no such built-in scene{}; there are: {}", name,
                               guess.empty() ? "" : fmt::format(", did you mean '{}'?", guess), listNames()));
}

/// `--material` calls the colour of absorption `attenuation`; where a scene has such a colour, so may the query.
std::string_view resolveAlias(const ParamSet& params, std::string_view key) {
  return key == "attenuation" && params.has("attenuation-distance") ? "color" : key;
}

}  // namespace

std::span<const BuiltinScene> builtinScenes() {
  static const std::vector<BuiltinScene> kScenes{
      describeRingScene(),     describeSphereScene(), describeSphereBoxScene(), describeSphereInBoxScene(),
      describeCognacScene(),   describeWaveScene(),   describeCubeScene(),      describePrismScene(),
      describeBuildingScene(), describePoolScene(),   describeSeabedScene(),    describeCoffeeScene(),
      describeSlabScene(),     describeObjectScene(),
  };
  return kScenes;
}

SceneData buildBuiltinScene(std::string_view query, float time) {
  const std::size_t mark = query.find('?');
  const BuiltinScene& entry = findScene(query.substr(0, mark));
  ParamSet params(entry.params);
  SceneData scene;
  try {
    if (mark != std::string_view::npos && mark + 1 < query.size())
      for (const auto& [key, value] : parseKeyValues(query.substr(mark + 1), '&'))
        params.set(resolveAlias(params, key), value);
    scene = entry.build(params, time);
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("builtin:{}: {}", entry.name, error.what()));
  }
  scene.name = "builtin:" + std::string(query);
  return scene;
}

}  // namespace nephroid
