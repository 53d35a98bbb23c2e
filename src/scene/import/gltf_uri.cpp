#include "scene/import/gltf_uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>

#include "core/file.h"
#include "nephroid/error.h"
#include "scene/import/gltf_document.h"

namespace nephroid::gltf {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& gltf_path, std::string_view place, std::string_view uri,
                         std::string_view problem) {
  throw InputError(fmt::format("{}: {}: URI '{}' {}", cleanPath(gltf_path), place, cleanName(uri), problem));
}

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const char lower = static_cast<char>(c | 0x20);
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

/// %XX escapes decoded; a '%' without two hexadecimal digits stands for itself, as browsers have it.
std::string decodePercent(std::string_view text) {
  std::string decoded;
  decoded.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape =
        text[i] == '%' && i + 2 < text.size() && hexDigit(text[i + 1]) >= 0 && hexDigit(text[i + 2]) >= 0;
    if (escape) {
      decoded += static_cast<char>(16 * hexDigit(text[i + 1]) + hexDigit(text[i + 2]));
      i += 2;
    } else {
      decoded += text[i];
    }
  }
  return decoded;
}

/// RFC 3986: letter, then letters, digits, '+', '-', '.', up to ':'. A one-letter scheme is a Windows drive.
bool hasScheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  if (colon == std::string_view::npos || colon == 0 || !std::isalpha(static_cast<unsigned char>(uri[0]))) return false;
  return std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon),
                     [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '-' || c == '.'; });
}

std::vector<std::byte> decodeData(const std::filesystem::path& gltf_path, std::string_view place, std::string_view uri,
                                  std::uint64_t max_bytes) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
    refuse(gltf_path, place, uri.substr(0, 60), "is not base64 data; encode it as 'data:...;base64,...'");
  // Three bytes for four digits; a few more are allowed for padding.
  if ((uri.size() - comma) / 4 * 3 > max_bytes + 3)
    refuse(gltf_path, place, uri.substr(0, 60), "holds more bytes than may be loaded");
  // tinygltf decodes the types that it knows; the type is of no interest here (images are recognised by content).
  const std::string known_type = "data:application/octet-stream;base64," + std::string(uri.substr(comma + 1));
  std::vector<unsigned char> decoded;
  std::string mime_type;
  if (!tinygltf::DecodeDataURI(&decoded, mime_type, known_type, 0, false))
    refuse(gltf_path, place, uri.substr(0, 60), "holds no valid base64 data");
  std::vector<std::byte> bytes(decoded.size());
  if (!decoded.empty()) std::memcpy(bytes.data(), decoded.data(), decoded.size());
  return bytes;
}

}  // namespace

std::vector<std::byte> readUri(const std::filesystem::path& gltf_path, std::string_view place, std::string_view uri,
                               std::uint64_t max_bytes) {
  if (uri.starts_with("data:")) return decodeData(gltf_path, place, uri, max_bytes);
  if (hasScheme(uri)) refuse(gltf_path, place, uri, "has a scheme; only files beside the glTF file and data: are read");
  const std::string decoded = decodePercent(uri);
  if (decoded.empty() || decoded.find('\0') != std::string::npos)
    refuse(gltf_path, place, uri, "names no file; expected a relative path");
  const std::filesystem::path relative(decoded);
  if (relative.has_root_path() || decoded[0] == '\\')
    refuse(gltf_path, place, uri, "is an absolute path; expected one relative to the glTF file's folder");
  if (std::any_of(relative.begin(), relative.end(), [](const auto& part) { return part == ".."; }))
    refuse(gltf_path, place, uri, "leaves the glTF file's folder; move the file beside it");
  const std::filesystem::path file = gltf_path.parent_path() / relative;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    refuse(gltf_path, place, uri, "names a file that is missing or not a regular file");
  return readFile(file, max_bytes);
}

}  // namespace nephroid::gltf
