// Reading and writing whole files without losing anything.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nephroid {

/// Files above this are refused on reading: it bounds what a damaged or hostile input can make us allocate.
inline constexpr std::uint64_t kMaxFileBytes = std::uint64_t{4} << 30;

/// The whole file.
/// @throws InputError if it is missing, not a regular file, unreadable or above `max_bytes`
std::vector<std::byte> readFile(const std::filesystem::path& path, std::uint64_t max_bytes = kMaxFileBytes);

/// Writes `bytes` to a temporary file beside `path` (name `.PATH.XXXXXX`), flushes it to the disk and renames it:
/// a reader sees the old file or the new one, never a half. On failure the temporary file is removed and the old
/// file is untouched.
/// @throws ResourceError naming the path and the cause (full disk, no permission, no such folder, is a folder)
void writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// As above, from a callback that is given the temporary path to write (for libraries that insist on a file name).
void writeFileAtomically(const std::filesystem::path& path,
                         const std::function<void(const std::filesystem::path&)>& write);

/// Fails early, before an hour of rendering, if `path` will not be writable (missing folder, no permission, a folder).
/// Leaves no trace.
/// @throws ResourceError
void checkWritable(const std::filesystem::path& path);

}  // namespace nephroid
