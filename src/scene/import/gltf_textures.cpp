#include "scene/import/gltf_textures.h"

#include <fmt/format.h>

#include "core/image/image_io.h"
#include "scene/import/gltf_materials.h"
#include "scene/import/gltf_value.h"

namespace nephroid::gltf {
namespace {

bool isKtx2(const ImageSource& image) { return image.mime_type == "image/ktx2" || image.uri.ends_with(".ktx2"); }

Wrap readWrap(Document& document, int mode, const std::string& place) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return Wrap::kRepeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return Wrap::kClamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return Wrap::kMirror;
    default:
      break;
  }
  document.warn(place, fmt::format("wrap mode {} is unknown; repeated instead", mode));
  return Wrap::kRepeat;
}

/// Decoded textures are many times the size of their files; this bounds them all together (8 GiB of 8-bit RGBA).
constexpr std::uint64_t kMaxPixelsTotal = std::uint64_t{1} << 31;

std::uint64_t countPixels(const DecodedImage& image) {
  return std::visit(
      [](const auto& i) { return static_cast<std::uint64_t>(i.width) * static_cast<std::uint64_t>(i.height); }, image);
}

}  // namespace

mat3 makeTextureTransform(vec2 offset, float rotation, vec2 scale) {
  const float c = std::cos(rotation), s = std::sin(rotation);
  return {vec3(c * scale.x, -s * scale.x, 0), vec3(s * scale.y, c * scale.y, 0), vec3(offset, 1)};
}

TextureReader::TextureReader(Document& document, SceneData& scene)
    : document_(document), scene_(scene), image_of_source_(document.images.size(), kNone) {}

TextureRef TextureReader::read(int texture, int texcoord, const tinygltf::Value& transform, const std::string& place) {
  TextureRef ref;
  if (texture < 0) return ref;
  const auto& textures = document_.model.textures;
  if (static_cast<std::size_t>(texture) >= textures.size())
    document_.fail(place, fmt::format("refers to texture {}, the file has {}", texture, textures.size()));
  const tinygltf::Texture& found = textures[static_cast<std::size_t>(texture)];
  const std::string texture_place = place + ": " + placeOf("textures", static_cast<std::size_t>(texture));
  const int source = chooseSource(found, texture_place);
  if (source < 0) return ref;
  ref.image = loadImage(source, texture_place);
  const auto& samplers = document_.model.samplers;
  if (found.sampler >= 0) {
    if (static_cast<std::size_t>(found.sampler) >= samplers.size())
      document_.fail(texture_place,
                     fmt::format("refers to sampler {}, the file has {}", found.sampler, samplers.size()));
    const tinygltf::Sampler& sampler = samplers[static_cast<std::size_t>(found.sampler)];
    const std::string sampler_place = placeOf("samplers", static_cast<std::size_t>(found.sampler));
    ref.wrap_u = readWrap(document_, sampler.wrapS, sampler_place);
    ref.wrap_v = readWrap(document_, sampler.wrapT, sampler_place);
    ref.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  }
  if (isPresent(transform)) {
    texcoord = getInt(transform, "texCoord", texcoord);
    ref.uv_from_texcoord =
        makeTextureTransform(getVec2(transform, "offset").value_or(vec2(0)), getFloat(transform, "rotation", 0),
                             getVec2(transform, "scale").value_or(vec2(1)));
  }
  if (texcoord > 1) {
    document_.warn(place, fmt::format("UV set {} is not read (only 0 and 1); set 0 is used", texcoord));
    texcoord = 0;
  }
  ref.texcoord = texcoord;
  return ref;
}

TextureRef TextureReader::read(const tinygltf::Value& texture_info, const std::string& place) {
  if (!isPresent(texture_info)) return {};
  return read(getInt(texture_info, "index", -1), getInt(texture_info, "texCoord", 0),
              getMember(getMember(texture_info, "extensions"), "KHR_texture_transform"), place);
}

/// The image to use: WebP if offered (it replaces the fallback at better quality), else the plain source.
int TextureReader::chooseSource(const tinygltf::Texture& texture, const std::string& place) {
  const int webp = getInt(getExtension(texture.extensions, "EXT_texture_webp"), "source", -1);
  if (webp >= 0) return webp;
  const bool has_ktx2 = isPresent(getExtension(texture.extensions, "KHR_texture_basisu"));
  if (has_ktx2 && texture.source < 0)
    document_.fail(place,
                   "KHR_texture_basisu (KTX2) is not supported and there is no other image; "
                   "convert it to PNG, JPEG or WebP");
  if (has_ktx2) document_.warn(place, "KHR_texture_basisu (KTX2) is not supported; the alternative image is used");
  if (texture.source < 0) document_.warn(place, "has no image and is ignored");
  return texture.source;
}

std::uint32_t TextureReader::loadImage(int source, const std::string& place) {
  if (static_cast<std::size_t>(source) >= document_.images.size())
    document_.fail(place, fmt::format("refers to image {}, the file has {}", source, document_.images.size()));
  const auto index = static_cast<std::size_t>(source);
  if (image_of_source_[index] != kNone) return image_of_source_[index];
  const ImageSource& image = document_.images[index];
  const std::string image_place = placeOf("images", index, image.name);
  if (isKtx2(image)) document_.fail(image_place, "KTX2 is not supported; convert it to PNG, JPEG or WebP");
  const std::vector<std::byte> bytes = readImageBytes(document_, image, image_place);
  DecodedImage decoded = decodeImage(bytes, cleanPath(document_.path) + ": " + image_place);
  std::uint64_t pixels = countPixels(decoded);
  for (const TextureImage& other : scene_.images) pixels += countPixels(other.image);
  if (pixels > kMaxPixelsTotal)
    document_.fail(image_place, fmt::format("the textures have more than {} pixels in all", kMaxPixelsTotal));
  const bool is_file = !image.uri.empty() && !image.uri.starts_with("data:");
  image_of_source_[index] = static_cast<std::uint32_t>(scene_.images.size());
  scene_.images.push_back({is_file ? cleanName(image.uri) : image_place, std::move(decoded)});
  return image_of_source_[index];
}

}  // namespace nephroid::gltf
