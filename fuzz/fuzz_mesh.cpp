// The mesh importer on arbitrary bytes; the first one chooses the format.
#include <array>

#include "fuzz_file.h"
#include "scene/import/import.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array kExtensions = {".ply", ".obj", ".stl"};
  if (size == 0) return 0;
  // 'p' of "ply" chooses PLY, so that plain files of that format are seeds as they are; others follow their first byte.
  const bool is_ply = data[0] == 'p';
  const std::size_t choice = is_ply ? 0 : 1 + data[0] % 2;
  return nephroid::fuzzing::runOnFile(data, size, kExtensions[choice],
                                      [](const auto& path) { nephroid::importMesh(path); });
}
