// What the tests of image files share: names for them, and the refusals they expect.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image_io.h"
#include "nephroid/error.h"

namespace nephroid {

/// A file of its own for each test and `suffix`, removed at the end of its scope.
class TemporaryPath {
 public:
  explicit TemporaryPath(const std::string& suffix) {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(::testing::TempDir()) / ("nephroid-" + std::string(info->test_suite_name()) + "-" +
                                                           info->name() + "-" + std::to_string(::getpid()) + suffix);
  }
  TemporaryPath(const TemporaryPath&) = delete;
  TemporaryPath& operator=(const TemporaryPath&) = delete;
  ~TemporaryPath() {
    std::error_code error;
    std::filesystem::remove(path_, error);
  }
  const std::filesystem::path& get() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::vector<std::byte> makeBytes(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

/// The message of the InputError with which `bytes` are refused; "decoded" if they are not.
inline std::string getRefusal(std::span<const std::byte> bytes) {
  try {
    decodeImage(bytes, "the image");
  } catch (const InputError& error) {
    return error.what();
  }
  return "decoded";
}

}  // namespace nephroid
