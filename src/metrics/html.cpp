#include "metrics/html.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "nephroid/error.h"

namespace nephroid {
namespace {

std::string replaceInvalidUtf8(std::string_view text) {
  const nlohmann::json json = std::string(text);
  return nlohmann::json::parse(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)).get<std::string>();
}

}  // namespace

std::string escapeHtml(std::string_view text) {
  std::string escaped;
  for (const char c : replaceInvalidUtf8(text)) {
    const auto byte = static_cast<unsigned char>(c);
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        if ((byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7f)
          escaped += "\xef\xbf\xbd";
        else
          escaped += c;
    }
  }
  return escaped;
}

std::string makePngUri(std::span<const std::byte> png) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string uri = "data:image/png;base64,";
  uri.reserve(uri.size() + (png.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < png.size(); i += 3) {
    const auto byte = [&](std::size_t k) { return i + k < png.size() ? std::to_integer<unsigned>(png[i + k]) : 0U; };
    const unsigned bits = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (unsigned digit = 0; digit < 4; ++digit)
      uri += i + digit <= png.size() ? kDigits[bits >> (18 - 6 * digit) & 63U] : '=';
  }
  return uri;
}

std::string fillTemplate(std::string_view page, const std::map<std::string, std::string, std::less<>>& values) {
  std::string filled;
  for (;;) {
    const std::size_t begin = page.find("{{");
    filled += page.substr(0, begin);
    if (begin == std::string_view::npos) return filled;
    const std::size_t end = page.find("}}", begin);
    const std::string_view name = page.substr(begin + 2, end - begin - 2);
    const auto found = values.find(name);
    if (end == std::string_view::npos || found == values.end())
      throw InternalError(fmt::format("template: nothing to put for '{}'", name));
    filled += found->second;
    page.remove_prefix(end + 2);
  }
}

}  // namespace nephroid
