// Layered EXR files, out and in: what a render of many layers adds to its time.
#include <benchmark/benchmark.h>

#include "core/image/image_io.h"
#include "core/sampling/sampler.h"
#include "support/scratch_folder.h"

namespace nephroid::bench {
namespace {

constexpr int kSize = 512;

/// As smooth as pictures are, with noise in the last digits as renders have: neither all zeros nor incompressible.
Image makePicture(int channels, std::uint32_t stream) {
  Image image(kSize, kSize, channels);
  std::uint32_t i = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      for (int c = 0; c < channels; ++c)
        image.at(x, y)[c] = std::sin(0.01F * static_cast<float>(x + c)) * std::cos(0.02F * static_cast<float>(y)) +
                            1.0F + 0.01F * Sampler(2, stream, i++).next1D();
  return image;
}

LayeredImage makeLayers() {
  LayeredImage image;
  image.width = image.height = kSize;
  image.layers = {{"beauty", makePicture(3, 1)},
                  {"caustic", makePicture(3, 2)},
                  {"normal", makePicture(3, 3)},
                  {"depth", makePicture(1, 4)}};
  image.metadata = {{"technique", "reference"}};
  return image;
}

std::int64_t countBytes(const LayeredImage& image) {
  std::size_t values = 0;
  for (const Layer& layer : image.layers) values += layer.image.pixels.size();
  return static_cast<std::int64_t>(values * sizeof(float));
}

void writeLayers(benchmark::State& state) {
  const testing::ScratchFolder folder;
  const LayeredImage image = makeLayers();
  for (auto _ : state) writeExr(folder / "layers.exr", image, state.range(0) != 0);
  state.SetBytesProcessed(state.iterations() * countBytes(image));
}
BENCHMARK(writeLayers)->Name("Exr/write/half")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

void readLayers(benchmark::State& state) {
  const testing::ScratchFolder folder;
  const LayeredImage image = makeLayers();
  writeExr(folder / "layers.exr", image, state.range(0) != 0);
  for (auto _ : state) {
    LayeredImage read = readExr(folder / "layers.exr");
    benchmark::DoNotOptimize(read);
  }
  state.SetBytesProcessed(state.iterations() * countBytes(image));
}
BENCHMARK(readLayers)->Name("Exr/read/half")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace nephroid::bench
