#include "scene/import/gltf_extensions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace nephroid::gltf {
namespace {

// KHR_texture_basisu is here because a texture may offer another image beside the KTX2 one; gltf_textures refuses by
// name where it does not.
constexpr std::array kSupported = std::to_array<std::string_view>({
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_basisu",
    "KHR_texture_transform",
});

bool isSupported(const std::string& name) {
  return std::find(kSupported.begin(), kSupported.end(), name) != kSupported.end();
}

}  // namespace

void checkExtensions(Document& document) {
  for (const std::string& name : document.model.extensionsRequired)
    if (!isSupported(name))
      document.fail("extensionsRequired",
                    fmt::format("{} is not supported; export the file without it", cleanName(name)));
  for (const std::string& name : document.model.extensionsUsed)
    if (!isSupported(name))
      document.warn("extensionsUsed", fmt::format("{} is not supported and ignored", cleanName(name)));
}

}  // namespace nephroid::gltf
