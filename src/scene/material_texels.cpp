#include "scene/material_texels.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/image/tonemap.h"

namespace nephroid {
namespace {

/// A texture of a material, which of its channels matter, and what they multiply.
struct Slot {
  TextureRef Material::*reference;
  bool is_srgb;
  int first_channel, channel_count;
  void (*apply)(Material& material, vec4 texel);
};

constexpr std::size_t kSlotCount = 5;
/// The slot of the base colour, whose values are ordered: brighter is more specular and more diffuse.
constexpr std::size_t kBaseColor = 4;

const std::array<Slot, kSlotCount>& slots() {
  static const std::array<Slot, kSlotCount> list{
      Slot{&Material::metallic_roughness_texture, false, 1, 2,
           [](Material& m, vec4 texel) { m.roughness *= texel.y, m.metallic *= texel.z; }},
      Slot{&Material::transmission_texture, false, 0, 1, [](Material& m, vec4 texel) { m.transmission *= texel.x; }},
      Slot{&Material::specular_texture, false, 3, 1, [](Material& m, vec4 texel) { m.specular_factor *= texel.w; }},
      Slot{&Material::specular_color_texture, true, 0, 3,
           [](Material& m, vec4 texel) { m.specular_color *= vec3(texel); }},
      Slot{&Material::base_color_texture, true, 0, 3, [](Material& m, vec4 texel) { m.base_color *= texel; }},
  };
  return list;
}

/// Linear value of each byte of a channel.
using ByteTable = std::array<float, 256>;

ByteTable makeByteTable(bool is_srgb) {
  ByteTable table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const float value = static_cast<float>(i) / 255.0F;
    table[i] = is_srgb ? linearFromSrgb(value) : value;
  }
  return table;
}

/// The texels of one texture in one slot, by index.
class TexelReader {
 public:
  TexelReader(const TextureImage& texture, const Slot& slot) : slot_(&slot), linear_(makeByteTable(slot.is_srgb)) {
    if (const auto* bytes = std::get_if<ByteImage>(&texture.image)) {
      bytes_ = bytes->pixels.data();
      width_ = bytes->width, height_ = bytes->height;
    } else {
      floats_ = &std::get<Image>(texture.image);
      width_ = floats_->width, height_ = floats_->height;
    }
  }

  int width() const { return width_; }
  int height() const { return height_; }
  bool isFloat() const { return bytes_ == nullptr; }
  const std::uint8_t* bytesOf(std::size_t index) const { return bytes_ + 4 * index; }

  int keyBits() const { return 8 * slot_->channel_count; }
  /// The bytes of the channels that matter; not for float images.
  std::uint64_t keyOf(std::size_t index) const {
    const std::uint8_t* p = bytesOf(index);
    const std::uint32_t all = p[0] | std::uint32_t{p[1]} << 8 | std::uint32_t{p[2]} << 16 | std::uint32_t{p[3]} << 24;
    return (all >> (8 * slot_->first_channel)) & ((1U << keyBits()) - 1U);
  }

  /// Linear RGBA.
  vec4 valueOf(std::size_t index) const {
    if (isFloat()) {
      const float* p = floats_->pixels.data() + index * static_cast<std::size_t>(floats_->channels);
      if (floats_->channels < 3) return {p[0], p[0], p[0], 1.0F};
      return {p[0], p[1], p[2], floats_->channels == 4 ? p[3] : 1.0F};
    }
    const std::uint8_t* p = bytesOf(index);
    return {linear_[p[0]], linear_[p[1]], linear_[p[2]], static_cast<float>(p[3]) / 255.0F};
  }

 private:
  const Slot* slot_;
  ByteTable linear_;
  const std::uint8_t* bytes_ = nullptr;
  const Image* floats_ = nullptr;
  int width_ = 0, height_ = 0;
};

/// Remembers combinations of texels that were met lately, and the brightest base colour each was met with.
class MetCombinations {
 public:
  /// @param key_bits  of all textures but the base colour's
  explicit MetCombinations(int key_bits) : brightness_(kPlaces, -kInfinity) {
    if (key_bits > kPlaceBits) keys_.resize(kPlaces);
  }

  /// Whether this is new, or brighter than it was; remembers it.
  bool meet(std::uint64_t key, float brightness) {
    if (keys_.empty()) {
      if (brightness <= brightness_[key]) return false;
    } else {
      const std::uint64_t whole = key;
      key = key * 0x9E3779B97F4A7C15U >> (64 - kPlaceBits);
      if (keys_[key] == whole && brightness <= brightness_[key]) return false;
      keys_[key] = whole;
    }
    brightness_[key] = brightness;
    return true;
  }

 private:
  /// A metallic-roughness texture has as many values: each has a place of its own.
  static constexpr int kPlaceBits = 16;
  static constexpr std::size_t kPlaces = std::size_t{1} << kPlaceBits;

  std::vector<float> brightness_;    ///< by place
  std::vector<std::uint64_t> keys_;  ///< by place; empty: the key itself is the place
};

/// Walks over the grid of the largest texture.
class TexelScan {
 public:
  TexelScan(const SceneData& scene, const Material& material) : material_(material), at_(material) {
    for (std::size_t s = 0; s < kSlotCount; ++s) {
      const TextureRef& reference = material.*slots()[s].reference;
      at_.*slots()[s].reference = TextureRef{};
      if (!reference.valid()) continue;
      textures_.push_back({s, TexelReader(scene.images[reference.image], slots()[s]), {}});
      width_ = std::max(width_, textures_.back().reader.width());
      height_ = std::max(height_, textures_.back().reader.height());
      has_floats_ = has_floats_ || textures_.back().reader.isFloat();
    }
    for (Texture& texture : textures_)
      for (int x = 0; x < width_; ++x) texture.columns.push_back(scalePosition(x, width_, texture.reader.width()));
    keys_.resize(static_cast<std::size_t>(width_));
    brightness_.resize(keys_.size());
  }

  void visitAll(const std::function<void(const Material&)>& visit) {
    int key_bits = 0;
    for (const Texture& texture : textures_)
      if (texture.slot != kBaseColor) key_bits += texture.reader.keyBits();
    MetCombinations met(key_bits);
    for (int y = 0; y < height_; ++y) {
      for (Texture& texture : textures_)
        texture.row = static_cast<std::size_t>(scalePosition(y, height_, texture.reader.height())) *
                      static_cast<std::size_t>(texture.reader.width());
      if (!has_floats_) readRow();
      for (std::size_t x = 0; x < keys_.size(); ++x) {
        const bool as_before = x > 0 && keys_[x] == keys_[x - 1] && brightness_[x] == brightness_[x - 1];
        if (has_floats_ || (!as_before && met.meet(keys_[x], brightness_[x]))) visit(resolve(x));
      }
    }
  }

 private:
  struct Texture {
    std::size_t slot;
    TexelReader reader;
    std::vector<std::uint32_t> columns;  ///< by column of the grid
    std::size_t row = 0;                 ///< where the present row begins
  };

  /// The cell of `size` in which the centre of cell `i` of `grid` lies; every one is met, as size <= grid.
  static std::uint32_t scalePosition(int i, int grid, int size) {
    return static_cast<std::uint32_t>((2 * static_cast<std::size_t>(i) + 1) * static_cast<std::size_t>(size) /
                                      (2 * static_cast<std::size_t>(grid)));
  }

  /// Keys and brightnesses of a row of the grid.
  void readRow() {
    std::ranges::fill(keys_, 0);
    for (const Texture& texture : textures_) {
      if (texture.slot == kBaseColor) {
        readBrightness(texture);
        continue;
      }
      for (std::size_t x = 0; x < keys_.size(); ++x)
        keys_[x] = keys_[x] << texture.reader.keyBits() | texture.reader.keyOf(texture.row + texture.columns[x]);
    }
  }

  void readBrightness(const Texture& texture) {
    static const ByteTable linear = makeByteTable(true);
    const vec3 weight(luminance(vec3(material_.base_color.x, 0, 0)), luminance(vec3(0, material_.base_color.y, 0)),
                      luminance(vec3(0, 0, material_.base_color.z)));
    for (std::size_t x = 0; x < brightness_.size(); ++x) {
      const std::uint8_t* p = texture.reader.bytesOf(texture.row + texture.columns[x]);
      brightness_[x] = weight.x * linear[p[0]] + weight.y * linear[p[1]] + weight.z * linear[p[2]];
    }
  }

  const Material& resolve(std::size_t x) {
    at_.base_color = material_.base_color;
    at_.metallic = material_.metallic, at_.roughness = material_.roughness;
    at_.transmission = material_.transmission;
    at_.specular_factor = material_.specular_factor, at_.specular_color = material_.specular_color;
    for (const Texture& texture : textures_)
      slots()[texture.slot].apply(at_, texture.reader.valueOf(texture.row + texture.columns[x]));
    return at_;
  }

  const Material& material_;
  Material at_;
  std::vector<Texture> textures_;
  int width_ = 0, height_ = 0;
  bool has_floats_ = false;  ///< their values are not told apart: each texel is visited
  // Of the present row of the grid, by column.
  std::vector<std::uint64_t> keys_;
  std::vector<float> brightness_;
};

/// Least and largest values per channel.
std::array<vec4, 2> findExtremes(const TextureImage& texture, const Slot& slot) {
  const TexelReader reader(texture, slot);
  vec4 least(kInfinity), largest(-kInfinity);
  const std::size_t count = static_cast<std::size_t>(reader.width()) * reader.height();
  for (std::size_t i = 0; i < count; ++i) {
    least = glm::min(least, reader.valueOf(i));
    largest = glm::max(largest, reader.valueOf(i));
  }
  return {least, largest};
}

bool liesAlike(const TextureRef& a, const TextureRef& b) {
  return a.texcoord == b.texcoord && a.uv_from_texcoord == b.uv_from_texcoord;
}

}  // namespace

bool hasLobeTextures(const Material& material) {
  return std::ranges::any_of(slots(), [&](const Slot& slot) { return (material.*slot.reference).valid(); });
}

void visitTexels(const SceneData& scene, const Material& material, const std::function<void(const Material&)>& visit) {
  const TextureRef* first = nullptr;
  for (const Slot& slot : slots()) {
    const TextureRef& reference = material.*slot.reference;
    if (!reference.valid()) continue;
    if (first == nullptr) first = &reference;
    if (liesAlike(*first, reference)) continue;
    for (const vec4& extreme : findExtremes(scene.images[reference.image], slot)) {
      Material fixed = material;
      slot.apply(fixed, extreme);
      fixed.*slot.reference = TextureRef{};
      visitTexels(scene, fixed, visit);
    }
    return;
  }
  if (first == nullptr)
    visit(material);
  else
    TexelScan(scene, material).visitAll(visit);
}

}  // namespace nephroid
