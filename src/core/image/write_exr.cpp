// A render's layers as one EXR file of one part. It is built in memory and written in one go, so that devices and pipes
// work as targets and no half file is left on any error.

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "core/file.h"
#include "core/image/exr_layers.h"
#include "core/image/image_io.h"
#include "nephroid/error.h"

namespace nephroid {
namespace {

/// Memory as OpenEXR's output, which goes back once to fill in the table of offsets.
class MemoryOutput : public Imf::OStream {
 public:
  explicit MemoryOutput(const std::string& label) : Imf::OStream(label.c_str()) {}

  void write(const char source[], int count) override {
    const std::size_t end = position_ + static_cast<std::size_t>(count);
    if (end > bytes_.size()) bytes_.resize(end);
    std::memcpy(bytes_.data() + position_, source, static_cast<std::size_t>(count));
    position_ = end;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t position_ = 0;
};

/// One channel of the file: every `stride`-th value from `offset` on of a layer.
struct ChannelSource {
  std::string name;
  const Image* image = nullptr;
  std::size_t offset = 0;
  bool half = false;
};

/// A number of an object or the like must stay exact, which a half is only up to 2048.
bool mayBeHalf(std::string_view layer) { return layer != "id"; }

std::vector<ChannelSource> listChannels(const LayeredImage& image, bool half) {
  std::vector<ChannelSource> channels;
  for (const Layer& layer : image.layers) {
    const Image& pixels = layer.image;
    if (pixels.width != image.width || pixels.height != image.height || (pixels.channels != 1 && pixels.channels != 3))
      throw InternalError(fmt::format("layer '{}' is {} x {} x {}, expected {} x {} x (1 or 3)", layer.name,
                                      pixels.width, pixels.height, pixels.channels, image.width, image.height));
    const bool stored_half = half && mayBeHalf(layer.name);
    if (pixels.channels == 1) {
      channels.push_back({makeChannelName(layer.name, getScalarComponent(layer.name)), &pixels, 0, stored_half});
      continue;
    }
    for (std::size_t c = 0; c < 3; ++c)
      channels.push_back({makeChannelName(layer.name, std::string_view("RGB").substr(c, 1)), &pixels, c, stored_half});
  }
  return channels;
}

/// Beyond the range of a half the nearest half, not infinity, which would poison every sum over the picture.
std::vector<Imath::half> convertToHalf(const Image& image) {
  std::vector<Imath::half> values(image.pixels.size());
  std::ranges::transform(image.pixels, values.begin(), [](float v) {
    constexpr float kLargestHalf = 65504.0F;
    return Imath::half(std::isnan(v) ? v : std::clamp(v, -kLargestHalf, kLargestHalf));
  });
  return values;
}

/// Of 1 to 9: noise does not compress, and more only takes time.
constexpr int kZipLevel = 1;

Imf::Header makeHeader(const LayeredImage& image, std::span<const ChannelSource> channels) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = kZipLevel;
  for (const ChannelSource& channel : channels)
    header.channels().insert(channel.name, Imf::Channel(channel.half ? Imf::HALF : Imf::FLOAT));
  for (const auto& [key, value] : image.metadata)
    header.insert(std::string(kMetadataPrefix) + key, Imf::StringAttribute(value));
  return header;
}

Imf::Slice makeSlice(const ChannelSource& channel, const void* pixels, std::size_t value_size) {
  const auto channel_count = static_cast<std::size_t>(channel.image->channels);
  const std::size_t pixel_size = channel_count * value_size;
  return Imf::Slice::Make(channel.half ? Imf::HALF : Imf::FLOAT,
                          static_cast<const char*>(pixels) + channel.offset * value_size, Imath::V2i(0, 0),
                          channel.image->width, channel.image->height, pixel_size,
                          pixel_size * static_cast<std::size_t>(channel.image->width));
}

std::vector<std::byte> encodeExr(const LayeredImage& image, const std::string& label, bool half) {
  const std::vector<ChannelSource> channels = listChannels(image, half);
  std::map<const Image*, std::vector<Imath::half>> halves;
  Imf::FrameBuffer source;
  for (const ChannelSource& channel : channels) {
    if (!channel.half) {
      source.insert(channel.name, makeSlice(channel, channel.image->pixels.data(), sizeof(float)));
      continue;
    }
    const auto [found, is_new] = halves.try_emplace(channel.image);
    if (is_new) found->second = convertToHalf(*channel.image);
    source.insert(channel.name, makeSlice(channel, found->second.data(), sizeof(Imath::half)));
  }
  MemoryOutput output(label);
  {
    // Its destructor writes the table of offsets.
    Imf::OutputFile file(output, makeHeader(image, channels), 0);
    file.setFrameBuffer(source);
    file.writePixels(image.height);
  }
  return output.bytes();
}

}  // namespace

void writeExr(const std::filesystem::path& path, const LayeredImage& image, bool half) {
  const std::string label = path.string();
  if (image.layers.empty()) throw InternalError(label + ": no layer to write");
  std::vector<std::byte> bytes;
  try {
    bytes = encodeExr(image, label, half);
  } catch (const std::bad_alloc&) {
    throw ResourceError(fmt::format("{}: not enough memory to encode {} x {} pixels of {} layers; ask for fewer layers",
                                    label, image.width, image.height, image.layers.size()));
  } catch (const Iex::BaseExc& error) {
    throw InternalError(fmt::format("{}: OpenEXR refuses to encode the layers: {}", label, error.what()));
  }
  writeFileAtomically(path, bytes);
}

}  // namespace nephroid
