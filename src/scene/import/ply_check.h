// Whether a PLY file is whole, before Assimp reads it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace nephroid {

/// Checks the header's form and that the data after it suffice for what it announces, lists included. Assimp's PLY
/// reader trusts both and runs past the end of files that were cut short.
/// @throws InputError
void checkPly(std::span<const std::byte> file, const std::filesystem::path& path);

}  // namespace nephroid
