#include "scene/import/gltf_document.h"

#include <fmt/format.h>

#include <cstring>
#include <sstream>

#include "core/file.h"
#include "nephroid/error.h"
#include "scene/import/gltf_meshopt.h"
#include "scene/import/gltf_schema.h"
#include "scene/import/gltf_uri.h"

namespace nephroid::gltf {
namespace {

using nlohmann::json;

/// Deeper JSON is refused: tinygltf copies `extras` and `extensions` recursively, and a deep enough nest would exhaust
/// the stack. Real files stay below twenty.
constexpr int kMaxJsonDepth = 128;

/// The two parts of a .glb, or a .gltf as the first alone.
struct Container {
  std::string_view json_text;
  std::span<const std::byte> binary;
  bool is_binary = false;
};

std::uint32_t readU32(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(bytes[offset + i]) << (8 * i);
  return value;
}

std::string_view asText(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Walks the chunks of a GLB: JSON must come first, BIN may come second, others are skipped.
Container openContainer(std::span<const std::byte> file, const Document& document) {
  constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBin = 0x004E4942;
  if (file.size() < 4 || readU32(file, 0) != kMagic) return {asText(file), {}, false};
  if (file.size() < 20) document.fail("GLB header", fmt::format("found {} bytes, expected at least 20", file.size()));
  if (readU32(file, 4) != 2)
    document.fail("GLB header", fmt::format("found version {}, expected 2; export as glTF 2.0", readU32(file, 4)));
  const std::uint64_t length = readU32(file, 8);
  if (length > file.size() || length < 20)
    document.fail("GLB header",
                  fmt::format("claims {} bytes, the file has {}; it is truncated or damaged", length, file.size()));
  Container container;
  container.is_binary = true;
  std::size_t offset = 12;
  for (int chunk = 0; offset + 8 <= length; ++chunk) {
    const std::uint64_t size = readU32(file, offset);
    const std::uint32_t type = readU32(file, offset + 4);
    if (size > length - offset - 8)
      document.fail(fmt::format("GLB chunk {}", chunk),
                    fmt::format("claims {} bytes, {} are left in the file", size, length - offset - 8));
    const auto bytes = file.subspan(offset + 8, size);
    if (chunk == 0 && type != kJson) document.fail("GLB chunk 0", "is not JSON; the file is damaged");
    if (chunk == 0) container.json_text = asText(bytes);
    if (chunk == 1 && type == kBin) container.binary = bytes;
    offset += 8 + size;
  }
  return container;
}

/// Refuses text that nests too deep. On the text and not while parsing: the JSON library's parser with a callback looks
/// at all earlier siblings after each object, which takes hours for a million nodes.
void checkDepth(std::string_view text, const Document& document) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string && c == '\\') ++i;  // the next character is escaped
    if (c == '"') in_string = !in_string;
    if (in_string) continue;
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (depth > kMaxJsonDepth)
      document.fail("JSON", fmt::format("nested more than {} levels deep; no glTF file needs that", kMaxJsonDepth));
  }
}

json parseJson(std::string_view text, const Document& document) {
  checkDepth(text, document);
  try {
    json root = json::parse(text.begin(), text.end());
    if (!root.is_object())
      document.fail("JSON", fmt::format("found {} at the top, expected an object", root.type_name()));
    return root;
  } catch (const json::exception& error) {
    document.fail("JSON", fmt::format("not readable as JSON ({})", cleanName(error.what())));
  }
}

void checkVersion(const json& root, const Document& document) {
  const auto asset = root.find("asset");
  const std::string version = asset == root.end() ? "" : asset->value("version", "");
  if (!version.starts_with("2."))
    document.fail("asset.version", fmt::format("found '{}', expected 2.x; export as glTF 2.0", cleanName(version)));
  const std::string least = asset->value("minVersion", "2.0");
  if (least != "2.0")
    document.fail("asset.minVersion", fmt::format("'{}' is newer than the 2.0 that is read here", cleanName(least)));
}

std::string getString(const json& object, const char* key) { return object.value(key, std::string()); }

void takeImages(json& root, Document& document) {
  const auto images = root.find("images");
  if (images == root.end()) return;
  for (const json& image : *images) {
    if (!image.is_object()) document.fail("images", "found an element that is not an object");
    document.images.push_back({cleanName(getString(image, "name")), getString(image, "uri"),
                               getString(image, "mimeType"), image.value("bufferView", -1)});
  }
  root.erase(images);
}

/// @param budget  bytes that may still be loaded; reduced by what is
std::vector<std::byte> loadBuffer(const json& buffer, std::size_t index, const Container& container,
                                  const Document& document, std::uint64_t& budget) {
  const std::string place = placeOf("buffers", index, getString(buffer, "name"));
  if (!buffer.contains("byteLength")) document.fail(place, "has no byteLength");
  const auto length = buffer["byteLength"].get<std::uint64_t>();
  const std::string uri = getString(buffer, "uri");
  std::vector<std::byte> bytes;
  if (!uri.empty()) {
    bytes = readUri(document.path, place, uri, budget);
  } else if (index == 0 && container.is_binary && !container.binary.empty()) {
    bytes.assign(container.binary.begin(), container.binary.end());
  } else {
    return bytes;  // a fallback for readers without EXT_meshopt_compression, or never used; views of it fail
  }
  if (bytes.size() < length)
    document.fail(place, fmt::format("has {} bytes of data, byteLength says {}", bytes.size(), length));
  bytes.resize(length);
  budget -= std::min<std::uint64_t>(budget, length);
  return bytes;
}

void takeBuffers(json& root, const Container& container, Document& document) {
  const auto buffers = root.find("buffers");
  if (buffers == root.end()) return;
  std::uint64_t budget = kMaxFileBytes;
  for (std::size_t i = 0; i < buffers->size(); ++i) {
    if (!(*buffers)[i].is_object()) document.fail("buffers", "found an element that is not an object");
    document.buffers.push_back(loadBuffer((*buffers)[i], i, container, document, budget));
  }
  root.erase(buffers);
}

/// Moves index accessors to `kIndicesAttribute`.
void moveIndices(json& root, const Document& document) {
  const auto meshes = root.find("meshes");
  if (meshes == root.end()) return;
  for (std::size_t m = 0; m < meshes->size(); ++m) {
    json& mesh = (*meshes)[m];
    const auto primitives = mesh.find("primitives");
    if (primitives == mesh.end()) document.fail(placeOf("meshes", m), "has no primitives");
    for (json& primitive : *primitives) {
      if (!primitive.contains("attributes")) document.fail(placeOf("meshes", m), "has a primitive without attributes");
      primitive["attributes"].erase(kIndicesAttribute);
      if (!primitive.contains("indices")) continue;
      primitive["attributes"][kIndicesAttribute] = primitive["indices"];
      primitive.erase("indices");
    }
  }
}

void forEachLine(const std::string& text, const auto& use) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) use(cleanName(line));
}

void buildModel(const json& root, Document& document) {
  const std::string text = root.dump();
  tinygltf::TinyGLTF loader;
  std::string error, warning;
  bool loaded = false;
  try {
    loaded = loader.LoadASCIIFromString(&document.model, &error, &warning, text.data(),
                                        static_cast<unsigned int>(text.size()), "");
  } catch (const json::exception& exception) {
    error = exception.what();
  }
  if (!loaded) {
    std::string first = "not a valid glTF structure";
    forEachLine(error, [&](const std::string& line) { first += " (" + line + ")"; });
    document.fail("JSON", first);
  }
  forEachLine(error + warning, [&](const std::string& line) { document.warn("JSON", line); });
}

}  // namespace

std::string placeOf(std::string_view array, std::size_t index, std::string_view name) {
  return name.empty() ? fmt::format("{}[{}]", array, index) : fmt::format("{}[{}] '{}'", array, index, cleanName(name));
}

void Document::fail(std::string_view place, std::string_view problem) const {
  throw InputError(fmt::format("{}: {}: {}", cleanPath(path), place, problem));
}

void Document::warn(std::string_view place, std::string_view problem) {
  warnings.add(fmt::format("{}: {}", place, problem));
}

ViewBytes Document::storedView(int buffer, std::size_t offset, std::size_t length, std::string_view place) const {
  if (buffer < 0 || static_cast<std::size_t>(buffer) >= buffers.size())
    fail(place, fmt::format("refers to buffer {}, the file has {}", buffer, buffers.size()));
  const auto& bytes = buffers[static_cast<std::size_t>(buffer)];
  if (offset > bytes.size() || length > bytes.size() - offset)
    fail(place, fmt::format("bytes {} to {} lie outside buffer {} of {} bytes", offset, offset + length, buffer,
                            bytes.size()));
  return {std::span(bytes).subspan(offset, length), 0};
}

ViewBytes Document::view(int index, std::string_view place) const {
  if (index < 0 || static_cast<std::size_t>(index) >= model.bufferViews.size())
    fail(place, fmt::format("refers to bufferView {}, the file has {}", index, model.bufferViews.size()));
  const auto i = static_cast<std::size_t>(index);
  const tinygltf::BufferView& view = model.bufferViews[i];
  if (!decompressed.empty() && !decompressed[i].empty()) return {decompressed[i], view.byteStride};
  ViewBytes bytes = storedView(view.buffer, view.byteOffset, view.byteLength,
                               fmt::format("{}: {}", place, placeOf("bufferViews", i)));
  bytes.stride = view.byteStride;
  return bytes;
}

Document loadDocument(const std::filesystem::path& path) {
  Document document;
  document.path = path;
  // A .glb cannot be larger than its 32-bit length, and JSON text is handed to tinygltf with one.
  const std::vector<std::byte> file = readFile(path, std::uint64_t{1} << 32);
  const Container container = openContainer(file, document);
  json root = parseJson(container.json_text, document);
  checkTypes(root, path);
  checkVersion(root, document);
  takeImages(root, document);
  takeBuffers(root, container, document);
  moveIndices(root, document);
  root.erase("skins");  // unused, and tinygltf complains about valid ones
  buildModel(root, document);
  decompressViews(document);
  return document;
}

std::vector<std::byte> readImageBytes(const Document& document, const ImageSource& image, std::string_view place) {
  if (!image.uri.empty()) return readUri(document.path, place, image.uri, kMaxFileBytes);
  if (image.buffer_view < 0) document.fail(place, "has neither a URI nor a bufferView");
  const ViewBytes view = document.view(image.buffer_view, place);
  return {view.bytes.begin(), view.bytes.end()};
}

}  // namespace nephroid::gltf
