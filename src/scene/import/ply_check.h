// Whether a PLY file is whole, before Assimp reads it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace nephroid {

/// Checks the header's form and that the data after it suffice for what it announces, lists included. Assimp's PLY
/// reader trusts both and runs past the end of files that were cut short.
///
/// @return  the file under a header of our writing, so that Assimp reads the very header that was checked: it takes
///          comments for elements and ends words at other characters. Only what makes triangles keeps its name.
/// @throws InputError
std::vector<std::byte> checkPly(std::vector<std::byte> file, const std::filesystem::path& path);

}  // namespace nephroid
