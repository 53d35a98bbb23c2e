// Where benchmarks and fuzzers of files keep them.
#pragma once

#include <unistd.h>
#include <filesystem>
#include <string>
#include <system_error>

namespace nephroid::testing {

/// A folder of this process for temporary files, gone at the end of its scope.
class ScratchFolder {
 public:
  ScratchFolder() : path_(std::filesystem::temp_directory_path() / ("nephroid_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace nephroid::testing
