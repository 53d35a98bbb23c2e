// URIs inside glTF files: data URIs, and files beside the glTF file. Nothing else is ever opened.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace nephroid::gltf {

/// The bytes that `uri` names.
///
/// A relative path (percent-encoded, UTF-8) is resolved in the folder of `gltf_path` and may lead into subfolders but
/// not out: a scene from the web must not read, say, a private key next door. Absolute paths, "..", and schemes other
/// than base64 "data:" are refused by name.
/// @param max_bytes  larger contents are refused before they are read
/// @throws InputError naming file, place and URI
std::vector<std::byte> readUri(const std::filesystem::path& gltf_path, std::string_view place, std::string_view uri,
                               std::uint64_t max_bytes);

}  // namespace nephroid::gltf
