// Checkpoints of the reference on arbitrary bytes. With the digest made right, so that it does not end every input.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "core/content_hash.h"
#include "fuzz_file.h"
#include "techniques/reference/checkpoint.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nephroid::ContentHash hash;
  hash.add(std::as_bytes(std::span(data, size)));
  const std::uint64_t digest = hash.digest();
  std::vector<std::uint8_t> file(data, data + size);
  file.resize(size + sizeof(digest));
  std::memcpy(file.data() + size, &digest, sizeof(digest));
  return nephroid::fuzzing::runOnFile(file.data(), file.size(), ".checkpoint", [](const auto& path) {
    const std::vector<std::byte> state = nephroid::readCheckpoint(path, {});
    nephroid::StateReader reader(state);
    std::vector<double> values(3);
    reader.values(std::span(values));
    return reader.isDone();
  });
}
