#include "techniques/reference/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string_view>

#include "core/content_hash.h"
#include "core/file.h"
#include "nephroid/error.h"

namespace nephroid {
namespace {

namespace fs = std::filesystem;

/// First bytes of a file; the last one counts the versions of its form.
constexpr std::string_view kMagic = "NPHCKPT\x01";

std::string formatFacts(const CheckpointFacts& facts) {
  std::string text;
  for (const auto& [name, value] : facts) text += fmt::format("{}\t{}\n", name, value);
  return text;
}

CheckpointFacts parseFacts(std::string_view text) {
  CheckpointFacts facts;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    const std::size_t tab = std::min(line.find('\t'), line.size());
    facts.emplace_back(line.substr(0, tab), line.substr(std::min(tab + 1, line.size())));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return facts;
}

std::uint64_t digestOf(std::span<const std::byte> bytes) {
  ContentHash hash;
  hash.add(bytes);
  return hash.digest();
}

[[noreturn]] void failDamaged(const fs::path& path) {
  throw InputError(fmt::format(
      "{}: the checkpoint is damaged or cut short; delete it to begin anew, or put back a copy that is whole",
      path.string()));
}

/// A number and as many bytes.
std::span<const std::byte> takeSection(const fs::path& path, std::span<const std::byte>& rest) {
  std::uint64_t size = 0;
  if (rest.size() < sizeof(size)) failDamaged(path);
  std::memcpy(&size, rest.data(), sizeof(size));
  rest = rest.subspan(sizeof(size));
  if (size > rest.size()) failDamaged(path);
  const auto section = rest.first(static_cast<std::size_t>(size));
  rest = rest.subspan(section.size());
  return section;
}

void checkFacts(const fs::path& path, const CheckpointFacts& found, const CheckpointFacts& expected) {
  const auto fail = [&](std::string_view name, std::string_view theirs, std::string_view ours) {
    throw InputError(fmt::format(
        "{}: is of another render: its {} is {}, here it is {}; render as it was begun, or delete it to begin anew",
        path.string(), name, theirs, ours));
  };
  for (std::size_t i = 0; i < std::max(found.size(), expected.size()); ++i) {
    if (i >= found.size()) fail(expected[i].first, "not given", expected[i].second);
    if (i >= expected.size()) fail(found[i].first, found[i].second, "not given");
    if (found[i].first != expected[i].first) fail("list of parameters", found[i].first, expected[i].first);
    if (found[i].second != expected[i].second) fail(expected[i].first, found[i].second, expected[i].second);
  }
}

}  // namespace

void writeCheckpoint(const fs::path& path, const CheckpointFacts& facts, std::span<const std::byte> state) {
  const std::string text = formatFacts(facts);
  StateWriter file;
  file.values(std::span(kMagic));
  file.value(std::uint64_t{text.size()});
  file.values(std::span(std::string_view(text)));
  file.value(std::uint64_t{state.size()});
  file.values(state);
  file.value(digestOf(file.bytes()));
  writeFileAtomically(path, file.bytes());
}

std::vector<std::byte> readCheckpoint(const fs::path& path, const CheckpointFacts& facts) {
  // A checkpoint is as large as the picture; the user's own file system bounds it.
  const std::vector<std::byte> bytes = readFile(path, std::numeric_limits<std::uint64_t>::max());
  std::span<const std::byte> rest(bytes);
  if (rest.size() < kMagic.size() || std::memcmp(rest.data(), kMagic.data(), kMagic.size()) != 0)
    throw InputError(fmt::format("{}: not a checkpoint of this version of nephroid; name another file, or delete it",
                                 path.string()));
  std::uint64_t digest = 0;
  if (rest.size() < kMagic.size() + sizeof(digest)) failDamaged(path);
  std::memcpy(&digest, &bytes[bytes.size() - sizeof(digest)], sizeof(digest));
  rest = rest.first(bytes.size() - sizeof(digest));
  if (digestOf(rest) != digest) failDamaged(path);
  rest = rest.subspan(kMagic.size());
  const auto text = takeSection(path, rest);
  checkFacts(path, parseFacts({reinterpret_cast<const char*>(text.data()), text.size()}), facts);
  const auto state = takeSection(path, rest);
  if (!rest.empty()) failDamaged(path);
  return {state.begin(), state.end()};
}

}  // namespace nephroid
