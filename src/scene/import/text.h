// Words for messages: one line each, whatever a file calls its things.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace nephroid {

/// `name` without control characters (they become '?') and at most 80 bytes long, cut between UTF-8 characters: a
/// hostile name can neither break a message into lines nor drown it.
std::string cleanName(std::string_view name);
/// The same for the path of a file, at its full length: a message that does not name the file is of no use.
std::string cleanPath(const std::filesystem::path& path);

/// Collects warnings in the order of their first appearance, each once.
class WarningList {
 public:
  void add(std::string warning);
  std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::vector<std::string> lines_;
  std::unordered_set<std::string> seen_;
};

}  // namespace nephroid
