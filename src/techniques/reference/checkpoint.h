// Checkpoints: what a progressive render needs to go on after the process has ended, in one file.
//
// A header of facts - scene, camera, size, seed, parameters - that must be the same where it goes on, the state as the
// bytes of its values, and a digest of all. Written under another name and renamed, so that a file is whole or old;
// read without trust: sizes are checked before anything is taken, and damage is found by the digest. For machines of
// one byte order, as everything that is not exchanged.
#pragma once

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace nephroid {

/// What tells one render from another: (name, value), both of one line.
using CheckpointFacts = std::vector<std::pair<std::string, std::string>>;

/// Values to bytes. StateReader takes them back in the same order: one function that visits both serves as well.
class StateWriter {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void value(const T& value) { values(std::span(&value, 1)); }
  template <class T>
  void values(std::span<T> values) {
    const auto bytes = std::as_bytes(values);
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

class StateReader {
 public:
  /// @param bytes  must outlive it
  explicit StateReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void value(T& value) { values(std::span(&value, 1)); }
  /// Takes as many as there is room for. Once the bytes are short it leaves all that follows as it is.
  template <class T>
  void values(std::span<T> values) {
    fits_ = fits_ && values.size_bytes() <= bytes_.size();
    if (!fits_ || values.empty()) return;
    std::memcpy(values.data(), bytes_.data(), values.size_bytes());
    bytes_ = bytes_.subspan(values.size_bytes());
  }
  /// Everything was there, and nothing is left.
  bool isDone() const { return fits_ && bytes_.empty(); }

 private:
  std::span<const std::byte> bytes_;
  bool fits_ = true;
};

/// @throws ResourceError (full disk, no permission); the old file, if any, is then untouched
void writeCheckpoint(const std::filesystem::path& path, const CheckpointFacts& facts, std::span<const std::byte> state);

/// The state in the file.
/// @throws InputError if it is no checkpoint, damaged, cut short, or of a render with other facts: the first that
///         differs is named with both values
std::vector<std::byte> readCheckpoint(const std::filesystem::path& path, const CheckpointFacts& facts);

}  // namespace nephroid
