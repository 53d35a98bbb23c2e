// The glTF importer on arbitrary bytes, as a .gltf or a .glb file.
#include "fuzz_file.h"
#include "scene/import/import.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return nephroid::fuzzing::runOnFile(data, size, NEPHROID_FUZZ_EXTENSION,
                                      [](const auto& path) { nephroid::importGltf(path, 0.5F); });
}
