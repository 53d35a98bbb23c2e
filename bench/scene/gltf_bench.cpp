// Import of a glTF file whose time goes into its geometry.
#include <benchmark/benchmark.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/import/import.h"
#include "support/scenes.h"
#include "support/scratch_folder.h"

namespace nephroid::bench {
namespace {

using nlohmann::json;

constexpr int kFloat = 5126, kUnsignedInt = 5125;

/// A document with one mesh, its arrays in one buffer file beside it.
class MeshFile {
 public:
  explicit MeshFile(const Mesh& mesh) {
    const json attributes = {{"POSITION", add(mesh.positions, kFloat, "VEC3", mesh.positions.size())},
                             {"NORMAL", add(mesh.normals, kFloat, "VEC3", mesh.normals.size())}};
    const int indices = add(mesh.triangles, kUnsignedInt, "SCALAR", 3 * mesh.triangles.size());
    root_["meshes"] = {{{"primitives", {{{"attributes", attributes}, {"indices", indices}}}}}};
    root_["buffers"] = {{{"uri", "data.bin"}, {"byteLength", bytes_.size()}}};
  }

  std::size_t byteCount() const { return bytes_.size(); }

  std::filesystem::path write(const testing::ScratchFolder& folder) const {
    std::ofstream(folder / "data.bin", std::ios::binary) << bytes_;
    std::ofstream(folder / "scene.gltf", std::ios::binary) << root_.dump();
    return folder / "scene.gltf";
  }

 private:
  template <class T>
  int add(const std::vector<T>& values, int component_type, const char* type, std::size_t count) {
    const std::size_t length = values.size() * sizeof(T);
    root_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", length}});
    bytes_.append(reinterpret_cast<const char*>(values.data()), length);
    const std::size_t view = root_["bufferViews"].size() - 1;
    root_["accessors"].push_back(
        {{"bufferView", view}, {"componentType", component_type}, {"type", type}, {"count", count}});
    return static_cast<int>(root_["accessors"].size() - 1);
  }

  json root_ = {
      {"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
  std::string bytes_;
};

void importMeshFile(benchmark::State& state) {
  const testing::ScratchFolder folder;
  const MeshFile file(makeSphere("ball", dvec3(0), 1.0, static_cast<int>(state.range(0))));
  const std::filesystem::path path = file.write(folder);
  for (auto _ : state) {
    SceneData scene = importGltf(path, 0.0F);
    benchmark::DoNotOptimize(scene);
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(file.byteCount()));
}
BENCHMARK(importMeshFile)
    ->Name("Gltf/import/sphere")
    ->Arg(16)
    ->Arg(kBallSegments)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace nephroid::bench
