#include "scene/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>

#include "nephroid/error.h"
#include "scene/builtin/builtin.h"
#include "scene/import/import.h"

namespace nephroid {
namespace {

constexpr std::string_view kBuiltinPrefix = "builtin:";

std::string lowerExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// The first bytes of a file; fewer if it is shorter, none if it cannot be read.
std::string readHead(const std::filesystem::path& path) {
  std::string head(512, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return head;
}

/// GLB by its magic; the JSON form by its first character.
bool looksLikeGltf(std::string_view head) {
  if (head.starts_with("glTF")) return true;
  if (head.starts_with("\xEF\xBB\xBF")) head.remove_prefix(3);
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && head[first] == '{';
}

bool isMeshExtension(std::string_view extension) {
  constexpr std::array<std::string_view, 3> kMeshes{".ply", ".obj", ".stl"};
  return std::ranges::find(kMeshes, extension) != kMeshes.end();
}

[[noreturn]] void failMissing(std::string_view source) {
  const std::string_view name = source.substr(0, source.find('?'));
  for (const BuiltinScene& scene : builtinScenes())
    if (scene.name == name)
      throw InputError(
          fmt::format("{}: no such file; the built-in scene of that name is 'builtin:{}'", source, source));
  throw InputError(fmt::format(
      "{}: no such file; a scene is a .glb or .gltf file, or builtin:NAME (`nephroid scenes` lists them)", source));
}

}  // namespace

SceneData loadScene(std::string_view source, const LoadOptions& options) {
  if (source.starts_with(kBuiltinPrefix)) return buildBuiltinScene(source.substr(kBuiltinPrefix.size()), options.time);
  const std::filesystem::path path(source);
  std::error_code error;
  if (!std::filesystem::exists(path, error)) failMissing(source);
  const std::string extension = lowerExtension(path);
  if (isMeshExtension(extension))
    throw UsageError(
        fmt::format("{}: a bare mesh is not a scene: it has no light, floor or material; use 'builtin:object?mesh={}'",
                    source, source));
  if (extension == ".gltf" || extension == ".glb" || looksLikeGltf(readHead(path)))
    return importGltf(path, options.time);
  throw InputError(
      fmt::format("{}: neither glTF by its name nor by its content; a .glb or .gltf file is expected", source));
}

}  // namespace nephroid
