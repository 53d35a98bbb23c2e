#include "core/image/exr_chunks.h"

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfTileDescription.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

namespace nephroid {
namespace {

using Bytes = std::span<const std::byte>;

/// Little-endian unsigned number at the front.
template <class T>
T readNumber(Bytes bytes, std::uint64_t offset) {
  if (offset > bytes.size() || bytes.size() - offset < sizeof(T)) throw Iex::InputExc("the file ends too early");
  T value = 0;
  for (std::size_t i = sizeof(T); i-- > 0;) value = value << 8 | std::to_integer<T>(bytes[offset + i]);
  return value;
}

/// Rows that a block of scan lines holds; 0 for a compression that we do not know: its library is new enough.
int getBlockRows(Imf::Compression compression) {
  switch (compression) {
    case Imf::NO_COMPRESSION:
    case Imf::RLE_COMPRESSION:
    case Imf::ZIPS_COMPRESSION:
      return 1;
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
      return 16;
    case Imf::PIZ_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION:
      return 32;
    case Imf::DWAB_COMPRESSION:
      return 256;
    default:
      return 0;
  }
}

std::int64_t divideDown(std::int64_t dividend, int divisor) {
  return dividend >= 0 ? dividend / divisor : -((divisor - 1 - dividend) / divisor);
}

/// How many multiples of `step` lie in [first, last].
std::int64_t countSamples(int step, std::int64_t first, std::int64_t last) {
  return divideDown(last, step) - divideDown(first - 1, step);
}

struct Region {
  std::int64_t left, top, right, bottom;  ///< inclusive
};

std::uint64_t countUnpackedBytes(const Imf::ChannelList& channels, const Region& region) {
  std::int64_t count = 0;
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    const Imf::Channel& channel = it.channel();
    count += countSamples(channel.xSampling, region.left, region.right) *
             countSamples(channel.ySampling, region.top, region.bottom) * (channel.type == Imf::HALF ? 2 : 4);
  }
  return static_cast<std::uint64_t>(count);
}

/// What a deflate stream unpacks to, without keeping it; nothing if it is damaged or goes beyond `limit`.
std::optional<std::uint64_t> measureDeflate(Bytes packed, std::uint64_t limit) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(packed.data()));  // zlib's type; it only reads
  stream.avail_in = static_cast<uInt>(packed.size());
  std::array<Bytef, 32768> scratch{};
  int status = Z_OK;
  while (status == Z_OK && stream.total_out <= limit) {
    stream.next_out = scratch.data();
    stream.avail_out = static_cast<uInt>(scratch.size());
    status = inflate(&stream, Z_NO_FLUSH);
  }
  const std::uint64_t count = stream.total_out;
  inflateEnd(&stream);
  return status == Z_STREAM_END ? std::optional(count) : std::nullopt;
}

/// The same for OpenEXR's run-length coding: −n is followed by n bytes, n by one that stands for n + 1.
std::optional<std::uint64_t> measureRuns(Bytes packed) {
  std::uint64_t count = 0;
  while (!packed.empty()) {
    const int byte = std::to_integer<int>(packed[0]);
    const int code = byte < 128 ? byte : byte - 256;
    const std::size_t coded_size = code < 0 ? 1 + static_cast<std::size_t>(-code) : 2;
    if (coded_size > packed.size()) return std::nullopt;
    count += static_cast<std::uint64_t>(code < 0 ? -code : code + 1);
    packed = packed.subspan(coded_size);
  }
  return count;
}

/// @param expected  bytes of the pixels. A block that packing would not shrink is stored as it is.
bool isWholeBlock(Bytes block, std::uint64_t expected, Imf::Compression compression) {
  if (block.size() >= expected || block.empty()) return block.size() == expected;
  switch (compression) {
    case Imf::NO_COMPRESSION:
      return false;
    case Imf::RLE_COMPRESSION:
      return measureRuns(block) == expected;
    case Imf::ZIPS_COMPRESSION:
    case Imf::ZIP_COMPRESSION:
      return measureDeflate(block, expected) == expected;
    default:
      return true;
  }
}

/// Finds blocks by the table of a part.
struct BlockTable {
  Bytes bytes;
  std::size_t begin;
  std::size_t prefix_size;  ///< what stands before a block's size: part, coordinates

  void check(std::uint64_t index, const Region& region, const Imf::Header& header) const {
    const auto offset = readNumber<std::uint64_t>(bytes, begin + 8 * index);
    if (offset == 0 || offset > bytes.size()) throw Iex::InputExc("a block of pixels is missing");
    const auto size = readNumber<std::uint32_t>(bytes, offset + prefix_size);
    const Bytes rest = bytes.subspan(offset + prefix_size + sizeof size);
    if (size > rest.size()) throw Iex::InputExc("the file ends too early");
    if (!isWholeBlock(rest.first(size), countUnpackedBytes(header.channels(), region), header.compression()))
      throw Iex::InputExc("a block of pixels has the wrong length");
  }
};

void checkTiles(const BlockTable& table, const Imf::Header& header) {
  const Imath::Box2i& window = header.dataWindow();
  const std::int64_t tile_width = header.tileDescription().xSize, tile_height = header.tileDescription().ySize;
  std::uint64_t index = 0;  // level 0 stands first in the table, row by row
  for (std::int64_t y = window.min.y; y <= window.max.y; y += tile_height)
    for (std::int64_t x = window.min.x; x <= window.max.x; x += tile_width)
      table.check(index++,
                  {x, y, std::min<std::int64_t>(x + tile_width - 1, window.max.x),
                   std::min<std::int64_t>(y + tile_height - 1, window.max.y)},
                  header);
}

void checkScanLines(const BlockTable& table, const Imf::Header& header) {
  const Imath::Box2i& window = header.dataWindow();
  const int rows = getBlockRows(header.compression());
  if (rows == 0) return;
  std::uint64_t index = 0;  // from the top, in whatever order the blocks are stored
  for (std::int64_t y = window.min.y; y <= window.max.y; y += rows)
    table.check(index++, {window.min.x, y, window.max.x, std::min<std::int64_t>(y + rows - 1, window.max.y)}, header);
}

}  // namespace

void checkExrChunks(std::span<const std::byte> bytes, const ExrBlockLayout& layout, const Imf::Header& header) {
  const std::size_t part_size = layout.multi_part ? 4 : 0;
  const std::size_t coordinates_size = layout.tiled ? 16 : 4;
  const BlockTable table{bytes, layout.table_begin, part_size + coordinates_size};
  if (layout.tiled)
    checkTiles(table, header);
  else
    checkScanLines(table, header);
}

}  // namespace nephroid
