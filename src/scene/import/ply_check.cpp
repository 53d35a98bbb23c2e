#include "scene/import/ply_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "nephroid/error.h"
#include "scene/import/text.h"

namespace nephroid {
namespace {

enum class Format { kAscii, kLittleEndian, kBigEndian };

struct Property {
  std::string type, count_type, name;  ///< as in the file; no count_type: no list
  std::size_t bytes = 0;               ///< of a value
  std::size_t count_bytes = 0;         ///< of a list's length; 0: no list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  std::string format_name;
  Format format = Format::kAscii;
  std::vector<Element> elements;
  std::size_t bytes = 0;  ///< of the header, to where the data begin
};

class PlyChecker {
 public:
  PlyChecker(std::span<const std::byte> file, const std::filesystem::path& path)
      : text_(reinterpret_cast<const char*>(file.data()), file.size()), path_(path) {}

  void check() {
    readHeader();
    if (header_.format == Format::kAscii) {
      checkAscii();
    } else {
      checkBinary();
    }
  }

  std::size_t getHeaderBytes() const { return header_.bytes; }

  /// What Assimp is to see of the header: what it needs to find triangles.
  std::string writeHeader() const {
    std::string header = fmt::format("ply\nformat {} 1.0\n", header_.format_name);
    for (std::size_t i = 0; i < header_.elements.size(); ++i) {
      const Element& element = header_.elements[i];
      // Without properties it has no data, but Assimp would make room for any number of it.
      if (element.properties.empty() && header_.format != Format::kAscii) continue;
      const bool matters = element.name == "vertex" || element.name == "face" || element.name == "tristrips";
      header += fmt::format("element {} {}\n", matters ? element.name : fmt::format("skipped_{}", i), element.count);
      for (const Property& property : element.properties) {
        // Texture coordinates of faces: Assimp expects one pair per corner and reads past a face that has fewer
        // corners.
        const bool wanted = element.name == "vertex" || property.name != "texcoord";
        header += fmt::format("property {}{} {}\n", property.count_bytes > 0 ? "list " + property.count_type + " " : "",
                              property.type, wanted ? property.name : "skipped");
      }
    }
    return header + "end_header\n";
  }

 private:
  [[noreturn]] void fail(std::string_view problem) const {
    throw InputError(fmt::format("{}: {}", cleanPath(path_), problem));
  }

  static std::size_t typeBytes(std::string_view type) {
    for (const std::string_view one : {"char", "uchar", "int8", "uint8"})
      if (type == one) return 1;
    for (const std::string_view two : {"short", "ushort", "int16", "uint16"})
      if (type == two) return 2;
    for (const std::string_view four : {"int", "uint", "float", "int32", "uint32", "float32"})
      if (type == four) return 4;
    return type == "double" || type == "float64" ? 8 : 0;
  }

  void readHeader() {
    std::size_t begin = 0;
    for (std::size_t line = 1;; ++line) {
      const std::size_t end = text_.find('\n', begin);
      if (end == std::string_view::npos) fail("PLY header has no 'end_header'; the file is cut short");
      std::istringstream words(std::string(text_.substr(begin, end - begin)));
      begin = end + 1;
      std::string keyword;
      words >> keyword;
      if (keyword == "end_header") break;
      if (line == 1 && keyword != "ply") fail("does not begin with 'ply'; it is damaged or another format");
      if (!readLine(keyword, words))
        fail(fmt::format("PLY header, line {}: not understood; the file is damaged", line));
    }
    header_.bytes = begin;
    if (header_.format_name.empty()) fail("PLY header has no 'format'; the file is damaged");
    checkElements();
  }

  /// Assimp gives one mesh the vertices of every element "vertex", in an array as long as the first, and faces
  /// likewise.
  void checkElements() const {
    std::unordered_set<std::string_view> seen;
    for (const Element& element : header_.elements) {
      const std::string_view kind = element.name == "tristrips" ? "face" : std::string_view(element.name);
      if (!seen.insert(kind).second)
        fail(fmt::format("PLY header has more than one element '{}', expected one", cleanName(kind)));
    }
  }

  /// A word that Assimp ends where we do.
  static bool isPlain(std::string_view word) {
    return !word.empty() && std::none_of(word.begin(), word.end(), [](char c) {
      const auto byte = static_cast<unsigned char>(c);
      return byte <= 0x20 || byte == 0x7F;
    });
  }

  bool readLine(const std::string& keyword, std::istringstream& words) {
    if (keyword == "element") {
      Element element;
      if (!(words >> element.name >> element.count) || !isPlain(element.name)) return false;
      header_.elements.push_back(std::move(element));
      return true;
    }
    if (keyword == "property") return readProperty(words);
    if (keyword == "format") {
      std::string format;
      words >> format;
      if (!header_.format_name.empty()) return false;  // which of two would Assimp believe?
      if (format == "binary_little_endian") header_.format = Format::kLittleEndian;
      if (format == "binary_big_endian") header_.format = Format::kBigEndian;
      header_.format_name = format;
      return format == "ascii" || header_.format != Format::kAscii;
    }
    return keyword.empty() || keyword == "ply" || keyword == "comment" || keyword == "obj_info";
  }

  bool readProperty(std::istringstream& words) {
    Property property;
    words >> property.type;
    if (property.type == "list") {
      words >> property.count_type >> property.type;
      property.count_bytes = typeBytes(property.count_type);
      if (property.count_bytes == 0 || property.count_bytes == 8) return false;
    }
    property.bytes = typeBytes(property.type);
    if (!(words >> property.name) || !isPlain(property.name)) return false;
    if (property.bytes == 0 || header_.elements.empty()) return false;
    header_.elements.back().properties.push_back(std::move(property));
    return true;
  }

  /// A value in text takes a digit and a separator at least.
  void checkAscii() const {
    std::uint64_t left = (text_.size() - header_.bytes) / 2 + 1;
    for (const Element& element : header_.elements) {
      const std::uint64_t per_element = std::max<std::uint64_t>(element.properties.size(), 1);
      if (element.count > left / per_element) fail("has fewer values than its PLY header announces; it is cut short");
      left -= element.count * per_element;
    }
  }

  std::uint64_t readCount(std::size_t offset, std::size_t bytes) const {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < bytes; ++i) {
      const std::size_t place = header_.format == Format::kLittleEndian ? i : bytes - 1 - i;
      count |= std::uint64_t{static_cast<unsigned char>(text_[offset + i])} << (8 * place);
    }
    return count;
  }

  /// Walks all elements; only lists need a look inside.
  void checkBinary() const {
    std::size_t offset = header_.bytes;
    const auto advance = [&](std::uint64_t count, std::size_t bytes) {
      if (count > (text_.size() - offset) / bytes)
        fail("has fewer data than its PLY header announces; it is cut short");
      offset += count * bytes;
    };
    for (const Element& element : header_.elements) {
      if (element.properties.empty()) continue;
      for (std::uint64_t i = 0; i < element.count; ++i) {
        for (const Property& property : element.properties) {
          std::uint64_t count = 1;
          if (property.count_bytes > 0) {
            const std::size_t at = offset;
            advance(1, property.count_bytes);
            count = readCount(at, property.count_bytes);
          }
          advance(count, property.bytes);
        }
      }
    }
  }

  std::string_view text_;
  const std::filesystem::path& path_;
  Header header_;
};

}  // namespace

std::vector<std::byte> checkPly(std::vector<std::byte> file, const std::filesystem::path& path) {
  PlyChecker checker(file, path);
  checker.check();
  const std::string header = checker.writeHeader();
  const auto* first = reinterpret_cast<const std::byte*>(header.data());
  file.erase(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(checker.getHeaderBytes()));
  file.insert(file.begin(), first, first + header.size());
  return file;
}

}  // namespace nephroid
