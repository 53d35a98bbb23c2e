// Opening and reading OpenEXR files that may be hostile: what decode_exr.cpp and read_exr.cpp share.
#pragma once

#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>

#include <cstddef>
#include <exception>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/image/decoders.h"
#include "core/image/image.h"

namespace nephroid {

/// An EXR file in memory, opened. `bytes` must outlive it. Use from one thread.
class ExrFile {
 public:
  /// Reads the headers. May throw whatever OpenEXR throws: call within `guardExr`.
  ExrFile(std::span<const std::byte> bytes, const std::string& label);
  ExrFile(const ExrFile&) = delete;
  ExrFile& operator=(const ExrFile&) = delete;
  ~ExrFile();

  int partCount() const;
  const Imf::Header& header(int part) const;
  bool isDeep(int part) const;

  /// Refuses deep data, and sizes that would make OpenEXR take more memory than a real picture needs.
  /// @throws InputError
  void checkPart(int part) const;

  /// One image per list of channel names, interleaved in this order, as 32-bit floats; the highest resolution only.
  /// The memory grows with the rows that could be decoded, so a small file that claims a large picture costs little.
  std::vector<Image> readImages(int part, std::span<const std::vector<std::string>> channel_lists) const;

  /// RGB of a file of one part that holds Y and, at half resolution, RY and BY.
  Image readLuminanceChroma() const;

 private:
  class Stream;
  std::unique_ptr<Stream> makeStream() const;
  bool isTiled(int part) const;
  void checkBlocks(int part) const;

  std::span<const std::byte> bytes_;
  std::string label_;
  std::size_t tables_begin_ = 0;
  std::unique_ptr<Stream> stream_;
  std::unique_ptr<Imf::MultiPartInputFile> file_;
};

/// Whether a part has all these channels.
bool hasChannels(const Imf::Header& header, std::initializer_list<const char*> names);

/// "R, G, B": for messages; cut after a dozen.
std::string listChannels(const Imf::Header& header);

/// The reason out of OpenEXR's "Cannot read image file "". REASON".
std::string describeExrError(std::string_view message);

/// Runs `read` and turns what OpenEXR throws (and memory running out) into our errors.
template <class Function>
auto guardExr(const std::string& label, const Function& read) {
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw ResourceError(label + ": not enough memory for this OpenEXR image; scale it down");
  } catch (const std::exception& error) {
    failDamagedImage(label, "OpenEXR", describeExrError(error.what()));
  }
}

}  // namespace nephroid
