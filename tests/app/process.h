// Runs the real program as a process and catches all that it says.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace nephroid::test {

struct ProcessResult {
  int exit_code = -1;  ///< -1: ended by a signal
  int signal = 0;      ///< that signal, or 0
  std::string out, err;
};

struct ProcessOptions {
  std::filesystem::path directory = {};           ///< where it runs; empty: here
  std::string stdout_path = {};                   ///< redirect stdout there instead of catching it
  std::vector<std::string> environment = {};      ///< "KEY=VALUE", added to ours
  std::function<void(pid_t)> while_running = {};  ///< called once it was started
};

/// @param arguments  the first is the program: a path, or a name on PATH
ProcessResult runProcess(const std::vector<std::string>& arguments, const ProcessOptions& options = {});

/// The program under test with these arguments.
ProcessResult runNephroid(std::vector<std::string> arguments, const ProcessOptions& options = {});

/// A new empty folder that is removed at the end of its life.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

std::string readText(const std::filesystem::path& path);
void writeText(const std::filesystem::path& path, const std::string& text);

/// How many lines `text` has.
int countLines(const std::string& text);

}  // namespace nephroid::test
