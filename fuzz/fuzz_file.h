// Importers read files; a fuzzer has bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "nephroid/error.h"
#include "support/scratch_folder.h"

namespace nephroid::fuzzing {

/// Writes the input to a file of this process with the given extension and calls `import(path)`. Errors that Nephroid
/// throws on purpose are the expected outcome; anything else that leaves the importer is a finding.
template <class Import>
int runOnFile(const std::uint8_t* data, std::size_t size, const std::string& extension, const Import& import) {
  static const testing::ScratchFolder folder;
  const std::filesystem::path path = folder / ("input" + extension);
  {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  }
  try {
    import(path);
  } catch (const Error&) {
    return 0;
  }
  return 0;
}

}  // namespace nephroid::fuzzing
