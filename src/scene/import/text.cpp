#include "scene/import/text.h"

namespace nephroid {
namespace {

std::string replaceControls(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20U || c == 0x7F) c = '?';
  return text;
}

}  // namespace

std::string cleanName(std::string_view name) {
  constexpr std::size_t kMaxBytes = 80;  // a message stays readable on one terminal line or two
  std::size_t size = name.size();
  if (size > kMaxBytes) {
    size = kMaxBytes;
    while (size > 0 && (static_cast<unsigned char>(name[size]) & 0xC0U) == 0x80U) --size;
  }
  return replaceControls(std::string(name.substr(0, size))) + (size < name.size() ? "..." : "");
}

std::string cleanPath(const std::filesystem::path& path) { return replaceControls(path.string()); }

void WarningList::add(std::string warning) {
  if (seen_.insert(warning).second) lines_.push_back(std::move(warning));
}

}  // namespace nephroid
