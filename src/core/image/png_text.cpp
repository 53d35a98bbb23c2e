// What a PNG says of itself: its chunks tEXt and iTXt, read apart from the pixels, which need none of it.

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "core/image/image_io.h"

namespace nephroid {
namespace {

constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";

/// The characters before the next 0, which it leaves behind it. @return everything if there is none
std::string_view takeString(std::string_view& rest) {
  const std::string_view string = rest.substr(0, rest.find('\0'));
  rest.remove_prefix(std::min(string.size() + 1, rest.size()));
  return string;
}

std::string latin1ToUtf8(std::string_view text) {
  std::string utf8;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x80) {
      utf8 += c;
    } else {
      utf8 += static_cast<char>(0xC0U | (code >> 6U));
      utf8 += static_cast<char>(0x80U | (code & 0x3FU));
    }
  }
  return utf8;
}

void addText(std::map<std::string, std::string>& texts, std::string_view name, std::string_view data) {
  const std::string keyword = latin1ToUtf8(takeString(data));
  if (name == "tEXt") {
    texts.emplace(keyword, latin1ToUtf8(data));
    return;
  }
  // Whether and how it is compressed, language, the keyword in that language; then UTF-8.
  if (data.size() < 2 || data[0] != 0) return;
  data.remove_prefix(2);
  takeString(data);
  takeString(data);
  texts.emplace(keyword, data);
}

}  // namespace

std::map<std::string, std::string> readPngTexts(std::span<const std::byte> bytes) {
  constexpr std::size_t kNameAt = 4, kDataAt = 8, kFrame = 12;  // length, name; and the check sum behind the data
  std::map<std::string, std::string> texts;
  const std::string_view file(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!file.starts_with(kSignature)) return texts;
  for (std::size_t at = kSignature.size(); file.size() - at >= kFrame;) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < kNameAt; ++i) length = length << 8 | std::to_integer<std::size_t>(bytes[at + i]);
    if (length > file.size() - at - kFrame) break;
    const std::string_view name = file.substr(at + kNameAt, 4);
    if (name == "IEND") break;
    if (name == "tEXt" || name == "iTXt") addText(texts, name, file.substr(at + kDataAt, length));
    at += kFrame + length;
  }
  return texts;
}

}  // namespace nephroid
