// A digest of content: tells whether two are the same, and whether one was damaged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

namespace nephroid {

/// 64 bits of everything that was added, in its order. Any change within one aligned word of eight bytes changes it for
/// certain, others but for one in 2⁶⁴. Not against forgery. The same on machines of one byte order.
class ContentHash {
 public:
  void add(std::span<const std::byte> bytes) {
    addWord(bytes.size());
    for (; bytes.size() >= sizeof(std::uint64_t); bytes = bytes.subspan(sizeof(std::uint64_t)))
      addWord(readWord(bytes.first(sizeof(std::uint64_t))));
    if (!bytes.empty()) addWord(readWord(bytes));
  }
  void add(std::string_view text) { add(std::as_bytes(std::span(text))); }
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void add(T value) { addWord(readWord(std::as_bytes(std::span(&value, 1)))); }

  std::uint64_t digest() const { return state_; }

 private:
  static std::uint64_t readWord(std::span<const std::byte> bytes) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), bytes.size());
    return word;
  }
  /// Each step is a bijection of the state and of the word.
  void addWord(std::uint64_t word) {
    state_ = (state_ ^ word) * 0x9e3779b97f4a7c15ULL;
    state_ ^= state_ >> 32;
  }

  std::uint64_t state_ = 0x243f6a8885a308d3ULL;
};

}  // namespace nephroid
