// Importers read files; a fuzzer has bytes.
#pragma once

#include <unistd.h>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "nephroid/error.h"

namespace nephroid::fuzzing {

/// A folder of this process, gone when the process ends without a finding.
class ScratchFolder {
 public:
  ScratchFolder() : path_(std::filesystem::temp_directory_path() / ("nephroid_fuzz_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& getPath() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Writes the input to a file of this process with the given extension and calls `import(path)`. Errors that Nephroid
/// throws on purpose are the expected outcome; anything else that leaves the importer is a finding.
template <class Import>
int runOnFile(const std::uint8_t* data, std::size_t size, const std::string& extension, const Import& import) {
  static const ScratchFolder folder;
  const std::filesystem::path path = folder.getPath() / ("input" + extension);
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
