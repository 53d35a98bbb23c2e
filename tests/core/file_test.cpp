#include "core/file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>

#include "nephroid/error.h"

namespace nephroid {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::span<const std::byte> asBytes(std::string_view text) { return std::as_bytes(std::span(text)); }

std::string readText(const fs::path& path) {
  const std::vector<std::byte> bytes = readFile(path);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// What `action` throws as `Expected`, or a note that it did not.
template <class Expected, class Action>
std::string getMessage(const Action& action) {
  try {
    action();
  } catch (const Expected& error) {
    return error.what();
  }
  return "nothing thrown";
}

/// A folder of its own for each test.
class FileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) /
              ("nephroid-file-" + std::string(info->name()) + "-" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::size_t countEntries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

using ReadFile = FileTest;
using WriteFileAtomically = FileTest;
using CheckWritable = FileTest;

TEST_F(ReadFile, ReturnsWhatWasWritten) {
  const std::string text("a\0b\xff\n", 5);
  writeFileAtomically(folder_ / "x.bin", asBytes(text));
  EXPECT_EQ(readText(folder_ / "x.bin"), text);
}

TEST_F(ReadFile, ReturnsNothingOfAnEmptyFile) {
  writeFileAtomically(folder_ / "empty", asBytes(""));
  EXPECT_TRUE(readFile(folder_ / "empty").empty());
}

TEST_F(ReadFile, ReadsFilesWhoseSizeIsUnknown) { EXPECT_FALSE(readFile("/proc/self/status").empty()); }

TEST_F(ReadFile, NamesAMissingFile) {
  const std::string message = getMessage<InputError>([&] { readFile(folder_ / "none.glb"); });
  EXPECT_THAT(message, HasSubstr("none.glb: cannot read: No such file or directory"));
}

TEST_F(ReadFile, RefusesAFolder) {
  EXPECT_THAT(getMessage<InputError>([&] { readFile(folder_); }), HasSubstr("it is a folder"));
}

TEST_F(ReadFile, RefusesDevicesAndDoesNotWaitForAFifo) {
  EXPECT_THAT(getMessage<InputError>([&] { readFile("/dev/zero"); }), HasSubstr("not a regular file"));
  ASSERT_EQ(::mkfifo((folder_ / "fifo").c_str(), 0600), 0);
  EXPECT_THAT(getMessage<InputError>([&] { readFile(folder_ / "fifo"); }), HasSubstr("not a regular file"));
}

TEST_F(ReadFile, RefusesMoreThanTheLimitAndTakesTheLimitItself) {
  writeFileAtomically(folder_ / "x", asBytes("12345678"));
  EXPECT_EQ(readFile(folder_ / "x", 8).size(), 8U);
  EXPECT_THAT(getMessage<InputError>([&] { readFile(folder_ / "x", 7); }), HasSubstr("at most 7"));
  EXPECT_THROW(readFile("/proc/self/status", 10), InputError);
}

TEST_F(WriteFileAtomically, ReplacesTheOldFileAndLeavesNothingElse) {
  writeFileAtomically(folder_ / "x", asBytes("old and long"));
  writeFileAtomically(folder_ / "x", asBytes("new"));
  EXPECT_EQ(readText(folder_ / "x"), "new");
  EXPECT_EQ(countEntries(), 1U);
}

TEST_F(WriteFileAtomically, WritesBesideTheTargetUntilDone) {
  writeFileAtomically(folder_ / "x", [&](const fs::path& temporary) {
    EXPECT_EQ(temporary.parent_path(), folder_);
    EXPECT_TRUE(temporary.filename().string().starts_with(".x."));
    EXPECT_FALSE(fs::exists(folder_ / "x"));
    std::ofstream(temporary) << "content";
  });
  EXPECT_EQ(readText(folder_ / "x"), "content");
  EXPECT_EQ(countEntries(), 1U);
}

TEST_F(WriteFileAtomically, KeepsTheOldFileIfTheCallbackThrows) {
  writeFileAtomically(folder_ / "x", asBytes("old"));
  EXPECT_THROW(writeFileAtomically(folder_ / "x",
                                   [](const fs::path& temporary) {
                                     std::ofstream(temporary) << "half";
                                     throw std::runtime_error("stop");
                                   }),
               std::runtime_error);
  EXPECT_EQ(readText(folder_ / "x"), "old");
  EXPECT_EQ(countEntries(), 1U);
}

TEST_F(WriteFileAtomically, ReportsACallbackThatRemovesTheTemporaryFile) {
  writeFileAtomically(folder_ / "x", asBytes("old"));
  EXPECT_THROW(writeFileAtomically(folder_ / "x", [](const fs::path& temporary) { fs::remove(temporary); }),
               ResourceError);
  EXPECT_EQ(readText(folder_ / "x"), "old");
}

TEST_F(WriteFileAtomically, KeepsThePermissionsOfTheOldFile) {
  writeFileAtomically(folder_ / "x", asBytes("old"));
  fs::permissions(folder_ / "x", fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
  writeFileAtomically(folder_ / "x", asBytes("new"));
  EXPECT_EQ(static_cast<int>(fs::status(folder_ / "x").permissions()), 0640);
}

TEST_F(WriteFileAtomically, GivesANewFileThePermissionsOfTheUmask) {
  const mode_t before = ::umask(027);
  writeFileAtomically(folder_ / "x", asBytes("new"));
  ::umask(before);
  EXPECT_EQ(static_cast<int>(fs::status(folder_ / "x").permissions()), 0640);
}

TEST_F(WriteFileAtomically, WritesThroughASymbolicLink) {
  fs::create_directory(folder_ / "there");
  writeFileAtomically(folder_ / "there" / "x", asBytes("old"));
  fs::create_symlink("there/x", folder_ / "link");
  writeFileAtomically(folder_ / "link", asBytes("new"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(readText(folder_ / "there" / "x"), "new");
}

TEST_F(WriteFileAtomically, CreatesTheTargetOfADanglingLink) {
  fs::create_symlink("y", folder_ / "link");
  writeFileAtomically(folder_ / "link", asBytes("new"));
  EXPECT_EQ(readText(folder_ / "y"), "new");
}

TEST_F(WriteFileAtomically, ReportsACycleOfLinks) {
  fs::create_symlink("b", folder_ / "a");
  fs::create_symlink("a", folder_ / "b");
  EXPECT_THROW(writeFileAtomically(folder_ / "a", asBytes("x")), ResourceError);
}

TEST_F(WriteFileAtomically, WritesLongNamesAndNamesWithoutFolder) {
  const std::string name(255, 'n');
  writeFileAtomically(folder_ / name, asBytes("x"));
  EXPECT_EQ(readText(folder_ / name), "x");
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  writeFileAtomically("plain", asBytes("y"));
  fs::current_path(before);
  EXPECT_EQ(readText(folder_ / "plain"), "y");
  EXPECT_EQ(countEntries(), 2U);
}

TEST_F(WriteFileAtomically, NamesAFullDiskAndTheBytesNeeded) {
  const std::string message = getMessage<ResourceError>([] { writeFileAtomically("/dev/full", asBytes("12345")); });
  EXPECT_THAT(message, HasSubstr("/dev/full: cannot write: No space left on device (5 bytes needed)"));
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(WriteFileAtomically, WritesDirectlyToDevicesAndFifos) {
  writeFileAtomically("/dev/null", asBytes("x"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  ASSERT_EQ(::mkfifo((folder_ / "fifo").c_str(), 0600), 0);
  std::string received;
  std::thread reader([&] {
    std::ifstream in(folder_ / "fifo");
    std::getline(in, received);
  });
  writeFileAtomically(folder_ / "fifo", asBytes("through the pipe"));
  reader.join();
  EXPECT_EQ(received, "through the pipe");
  EXPECT_TRUE(fs::is_fifo(folder_ / "fifo"));
}

TEST_F(WriteFileAtomically, RefusesFoldersAndMissingFolders) {
  const auto write = [](const fs::path& path) {
    return getMessage<ResourceError>([&] { writeFileAtomically(path, asBytes("x")); });
  };
  EXPECT_THAT(write(folder_), HasSubstr("it is a folder"));
  EXPECT_THAT(write(folder_ / ""), HasSubstr("it is a folder"));
  EXPECT_THAT(write(folder_ / "none" / "x"), HasSubstr("create the folder first"));
  EXPECT_THAT(write(""), HasSubstr("empty"));
  writeFileAtomically(folder_ / "file", asBytes("x"));
  EXPECT_THAT(write(folder_ / "file" / "x"), HasSubstr("is a file"));
}

TEST_F(CheckWritable, LeavesNoTraceOfANewFile) {
  checkWritable(folder_ / "x");
  EXPECT_EQ(countEntries(), 0U);
}

TEST_F(CheckWritable, LeavesAnOldFileAsItIs) {
  writeFileAtomically(folder_ / "x", asBytes("old"));
  checkWritable(folder_ / "x");
  EXPECT_EQ(readText(folder_ / "x"), "old");
  EXPECT_EQ(countEntries(), 1U);
}

TEST_F(CheckWritable, TakesDevices) {
  EXPECT_NO_THROW(checkWritable("/dev/null"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(CheckWritable, RefusesWhatCannotBeWritten) {
  EXPECT_THROW(checkWritable(folder_), ResourceError);
  EXPECT_THROW(checkWritable(folder_ / "none" / "x"), ResourceError);
  EXPECT_THROW(checkWritable("/proc/nephroid.exr"), ResourceError);
}

TEST_F(CheckWritable, RefusesAFileWithoutWritePermission) {
  writeFileAtomically(folder_ / "x", asBytes("old"));
  fs::permissions(folder_ / "x", fs::perms::owner_read);
  // The superuser may write everything.
  if (::geteuid() == 0)
    EXPECT_NO_THROW(checkWritable(folder_ / "x"));
  else
    EXPECT_THROW(checkWritable(folder_ / "x"), ResourceError);
}

}  // namespace
}  // namespace nephroid
