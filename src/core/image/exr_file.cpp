#include "core/image/exr_file.h"

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfTileDescription.h>
#include <ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "core/image/exr_chunks.h"

namespace nephroid {

/// Memory as OpenEXR's input; reading beyond the end throws. It has no name: our messages name the file themselves.
class ExrFile::Stream : public Imf::IStream {
 public:
  explicit Stream(std::span<const std::byte> bytes) : Imf::IStream(""), bytes_(bytes) {}

  bool read(char target[], int count) override {
    if (count < 0 || position_ > bytes_.size() || static_cast<std::uint64_t>(count) > bytes_.size() - position_)
      throw Iex::InputExc("the file ends too early");
    std::memcpy(target, bytes_.data() + position_, static_cast<std::size_t>(count));
    position_ += static_cast<std::uint64_t>(count);
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::span<const std::byte> bytes_;
  std::uint64_t position_ = 0;
};

namespace {

/// Names in damaged files hold anything.
std::string makePrintable(std::string_view name) {
  constexpr std::size_t kMaxShown = 32;
  std::string text(name.substr(0, kMaxShown));
  std::ranges::replace_if(
      text, [](char c) { return c <= ' ' || c >= '\x7f'; }, '?');
  return text;
}

/// Rows that are decoded at a time: a multiple of what any scan-line compression packs together (256 at most), so that
/// nothing is decoded twice.
constexpr int kStripRows = 256;
/// A tile is held in memory whole, however small the picture: 4096² is the largest that writers are known to make.
constexpr std::int64_t kMaxTilePixels = std::int64_t{1} << 24;
/// One row of all channels: up to 256 such rows are held by the library at a time.
constexpr std::int64_t kMaxRowSamples = std::int64_t{1} << 22;

/// The zero-terminated text at the front of `rest`, which is taken off; nothing if it has no end.
std::optional<std::string_view> takeName(std::string_view& rest) {
  const std::size_t length = rest.find('\0');
  if (length == std::string_view::npos) return std::nullopt;
  const std::string_view name = rest.substr(0, length);
  rest.remove_prefix(length + 1);
  return name;
}

/// OpenEXR takes memory for an attribute before it reads it, up to 2 GiB, and fills it: so every attribute of every
/// header must fit into the file. (Name, type, size, that many bytes; an empty name ends a header, and in files of
/// several parts an empty header ends the headers.)
/// @return the offset of what follows the headers: the tables of block offsets
std::size_t checkAttributeSizes(std::span<const std::byte> bytes) {
  constexpr std::size_t kPreambleSize = 8;  // magic number, version and flags
  std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  rest.remove_prefix(std::min(kPreambleSize, rest.size()));
  const bool multi_part = bytes.size() >= kPreambleSize && Imf::isMultiPart(std::to_integer<int>(bytes[5]) << 8);
  for (bool header_is_empty = true;;) {
    const std::optional<std::string_view> name = takeName(rest);
    if (!name) throw Iex::InputExc("the header has no end");
    if (name->empty()) {
      if (!multi_part || header_is_empty) return bytes.size() - rest.size();
      header_is_empty = true;
      continue;
    }
    header_is_empty = false;
    std::uint32_t size = 0;
    if (!takeName(rest) || rest.size() < sizeof size) throw Iex::InputExc("the header has no end");
    for (std::size_t i = sizeof size; i-- > 0;) size = size << 8 | static_cast<unsigned char>(rest[i]);
    rest.remove_prefix(sizeof size);
    if (size > rest.size())
      throw Iex::InputExc(fmt::format("attribute '{}' is longer than the file", makePrintable(*name)));
    rest.remove_prefix(size);
  }
}

int getTileStripRows(const Imf::Header& header) {
  const int tile_rows = static_cast<int>(header.tileDescription().ySize);
  return std::max(tile_rows, kStripRows / tile_rows * tile_rows);
}

int countChannels(const Imf::Header& header) {
  int count = 0;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) ++count;
  return count;
}

Image makeEmptyImage(const Imath::Box2i& window, int channels) {
  Image image;
  image.width = window.max.x - window.min.x + 1;
  image.height = window.max.y - window.min.y + 1;
  image.channels = channels;
  image.pixels.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                       static_cast<std::size_t>(channels));
  return image;
}

/// Grows `image` by the rows of `strip` and makes them the target of its channels.
void appendRows(Image& image, std::span<const std::string> names, const Imath::Box2i& strip, Imf::FrameBuffer& target) {
  const std::size_t row_samples = static_cast<std::size_t>(image.width) * names.size();
  const int rows = strip.max.y - strip.min.y + 1;
  const std::size_t begin = image.pixels.size();
  image.pixels.resize(begin + row_samples * static_cast<std::size_t>(rows));
  for (std::size_t c = 0; c < names.size(); ++c)
    target.insert(names[c], Imf::Slice::Make(Imf::FLOAT, image.pixels.data() + begin + c, strip.min, image.width, rows,
                                             names.size() * sizeof(float), row_samples * sizeof(float)));
}

/// The rows [first, last] of the data window, in strips from the top.
template <class Function>
void forEachStrip(const Imath::Box2i& window, int rows, const Function& read) {
  for (std::int64_t first = window.min.y; first <= window.max.y; first += rows)
    read(static_cast<int>(first), static_cast<int>(std::min<std::int64_t>(first + rows - 1, window.max.y)));
}

}  // namespace

ExrFile::ExrFile(std::span<const std::byte> bytes, const std::string& label)
    : bytes_(bytes), label_(label), stream_(makeStream()) {
  tables_begin_ = checkAttributeSizes(bytes);
  // No threads of OpenEXR's own, and no guessing of a damaged table of offsets: what is missing is an error.
  file_ = std::make_unique<Imf::MultiPartInputFile>(*stream_, 0, false);
}

ExrFile::~ExrFile() = default;

std::unique_ptr<ExrFile::Stream> ExrFile::makeStream() const { return std::make_unique<Stream>(bytes_); }

int ExrFile::partCount() const { return file_->parts(); }

const Imf::Header& ExrFile::header(int part) const { return file_->header(part); }

bool ExrFile::isDeep(int part) const {
  return Imf::isNonImage(file_->version()) && header(part).hasType() && !Imf::isImage(header(part).type());
}

bool ExrFile::isTiled(int part) const {
  if (Imf::isMultiPart(file_->version())) return header(part).hasType() && Imf::isTiled(header(part).type());
  return Imf::isTiled(file_->version());
}

void ExrFile::checkPart(int part) const {
  if (isDeep(part))
    throw InputError(label_ +
                     ": deep OpenEXR images are not supported; flatten it, or export it without depth samples");
  const Imf::Header& head = header(part);
  const Imath::Box2i& window = head.dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  checkImageSize(width, std::int64_t{window.max.y} - window.min.y + 1, label_);
  const int channel_count = countChannels(head);
  if (width * channel_count > kMaxRowSamples)
    throw InputError(
        fmt::format("{}: OpenEXR image of {} channels, {} pixels wide; at most {} samples in a row are "
                    "accepted; remove channels",
                    label_, channel_count, width, kMaxRowSamples));
  if (!isTiled(part)) return;
  const Imf::TileDescription& tile = head.tileDescription();
  if (tile.xSize < 1 || tile.ySize < 1 || std::uint64_t{tile.xSize} * tile.ySize > kMaxTilePixels)
    throw InputError(
        fmt::format("{}: OpenEXR tiles of {} x {} pixels; at most {} pixels in a tile are accepted; store "
                    "it with smaller tiles or as scan lines",
                    label_, tile.xSize, tile.ySize, kMaxTilePixels));
}

void ExrFile::checkBlocks(int part) const {
  std::size_t table_begin = tables_begin_;
  for (int before = 0; before < part; ++before)
    table_begin += sizeof(std::uint64_t) * static_cast<std::size_t>(std::max(header(before).chunkCount(), 0));
  checkExrChunks(bytes_, {table_begin, Imf::isMultiPart(file_->version()), isTiled(part)}, header(part));
}

std::vector<Image> ExrFile::readImages(int part, std::span<const std::vector<std::string>> channel_lists) const {
  checkPart(part);
  checkBlocks(part);
  const Imath::Box2i window = header(part).dataWindow();
  Imf::InputPart input(*file_, part);
  std::vector<Image> images;
  for (const auto& names : channel_lists) images.push_back(makeEmptyImage(window, static_cast<int>(names.size())));
  const int strip_rows = isTiled(part) ? getTileStripRows(header(part)) : kStripRows;
  forEachStrip(window, strip_rows, [&](int first, int last) {
    Imf::FrameBuffer target;
    for (std::size_t i = 0; i < images.size(); ++i)
      appendRows(images[i], channel_lists[i], Imath::Box2i({window.min.x, first}, {window.max.x, last}), target);
    input.setFrameBuffer(target);
    input.readPixels(first, last);
  });
  return images;
}

Image ExrFile::readLuminanceChroma() const {
  if (partCount() != 1)
    throw InputError(label_ + ": luminance-chroma OpenEXR images of several parts are not supported; store it as RGB");
  checkPart(0);
  checkBlocks(0);
  const Imath::Box2i window = header(0).dataWindow();
  const std::unique_ptr<Stream> stream = makeStream();
  Imf::RgbaInputFile input(*stream, 0);
  Image image = makeEmptyImage(window, 3);
  const auto width = static_cast<std::size_t>(image.width);
  std::vector<Imf::Rgba> strip(width * kStripRows);
  forEachStrip(window, kStripRows, [&](int first, int last) {
    const Imath::Box2i rows(Imath::V2i(window.min.x, first), Imath::V2i(window.max.x, last));
    input.setFrameBuffer(Imf::ComputeBasePointer(strip.data(), rows), 1, width);
    input.readPixels(first, last);
    const std::size_t count = width * static_cast<std::size_t>(last - first + 1);
    for (std::size_t i = 0; i < count; ++i)
      image.pixels.insert(image.pixels.end(), {float(strip[i].r), float(strip[i].g), float(strip[i].b)});
  });
  return image;
}

bool hasChannels(const Imf::Header& header, std::initializer_list<const char*> names) {
  return std::ranges::all_of(names, [&](const char* name) { return header.channels().findChannel(name) != nullptr; });
}

std::string describeExrError(std::string_view message) {
  constexpr std::string_view kNoName = " \"\". ";
  const std::size_t at = message.find(kNoName);
  return std::string(at == std::string_view::npos ? message : message.substr(at + kNoName.size()));
}

std::string listChannels(const Imf::Header& header) {
  constexpr int kMaxListed = 12;
  std::string list;
  int count = 0;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    if (count == kMaxListed) return list + ", …";
    if (count++ > 0) list += ", ";
    list += makePrintable(it.name());
  }
  return list.empty() ? "none" : list;
}

}  // namespace nephroid
