// Whether the blocks of an EXR part hold as many bytes as its pixels need.
#pragma once

#include <ImfHeader.h>

#include <cstddef>
#include <span>

namespace nephroid {

/// How a part's blocks are found.
struct ExrBlockLayout {
  std::size_t table_begin = 0;  ///< offset in the file of the part's table of block offsets
  bool multi_part = false;      ///< the blocks begin with the number of their part
  bool tiled = false;
};

/// OpenEXR before 3.3 does not notice a block that unpacks to fewer bytes than its pixels take, and hands out what
/// happened to be in its buffer: stray memory as pixels, other ones in each run. So the blocks of a flat part's highest
/// resolution are measured first. PIZ, PXR24, B44 and DWA check themselves, unless the block is empty.
///
/// @throws Iex::InputExc if a block is missing, beyond the end of the file, too short or too long
/// @see "OpenEXR File Layout" of the OpenEXR documentation, sections "Offset Tables" and "Pixel Data"
void checkExrChunks(std::span<const std::byte> bytes, const ExrBlockLayout& layout, const Imf::Header& header);

}  // namespace nephroid
