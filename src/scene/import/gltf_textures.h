// How glTF materials refer to images.
#pragma once

#include <string>
#include <vector>

#include "scene/import/gltf_document.h"
#include "scene/scene_data.h"

namespace nephroid::gltf {

/// Turns textureInfo objects into TextureRefs and decodes the images behind them, each once.
class TextureReader {
 public:
  /// Both outlive the reader.
  TextureReader(Document& document, SceneData& scene);

  /// @param texture     index into the file's textures; -1: none
  /// @param texcoord    UV set
  /// @param extensions  those of the textureInfo, for KHR_texture_transform
  /// @throws InputError
  TextureRef read(int texture, int texcoord, const tinygltf::Value& transform, const std::string& place);
  /// The same for a textureInfo inside an extension.
  TextureRef read(const tinygltf::Value& texture_info, const std::string& place);
  template <class TextureInfo>
  TextureRef readInfo(const TextureInfo& info, const std::string& place) {
    const auto transform = info.extensions.find("KHR_texture_transform");
    return read(info.index, info.texCoord, transform == info.extensions.end() ? tinygltf::Value() : transform->second,
                place);
  }

 private:
  int chooseSource(const tinygltf::Texture& texture, const std::string& place);
  std::uint32_t loadImage(int source, const std::string& place);

  Document& document_;
  SceneData& scene_;
  std::vector<std::uint32_t> image_of_source_;  ///< index into scene.images per glTF image, kNone until decoded
};

}  // namespace nephroid::gltf
