#include "frame/photon_buffer.h"

#include "nephroid/error.h"
#include "support/gpu_fixture.h"

namespace nephroid {
namespace {

class PhotonBufferTest : public testing::GpuTest {};

TEST_F(PhotonBufferTest, KeepsWhatIsWrittenInOrder) {
  constexpr std::uint32_t kCount = 1000;
  PhotonBuffer photons(device(), kCount);
  photons.batch = {.light = 2, .emitted_count = kCount, .batch = 0, .grid_width = 0, .grid_height = 0, .band_count = 1};
  std::vector<Photon> written(kCount);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    written[i].flux = vec3(static_cast<float>(i), -1.0F, 0.5F);
    written[i].index = i;
  }
  gpu::CommandRecorder recorder(device());
  recorder.begin();
  for (const PhotonBuffer::Chunk& chunk : photons.chunks())
    recorder.upload(chunk.buffer, std::as_bytes(std::span(written).subspan(chunk.first, chunk.count)));
  recorder.submit();
  const std::vector<Photon> read = readPhotons(device(), photons);
  ASSERT_EQ(read.size(), kCount);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    ASSERT_EQ(read[i].index, i);
    ASSERT_EQ(read[i].flux, written[i].flux);
  }
}

TEST_F(PhotonBufferTest, IsCutWhereABufferWouldBeTooLarge) {
  // 4 million photons of 64 bytes: two chunks where 128 MiB is the limit, whole rows of 1000 in each.
  constexpr std::uint32_t kCount = 4'000'000, kRow = 1000;
  const PhotonBuffer photons(device(), kCount, kRow);
  std::uint32_t next = 0;
  for (const PhotonBuffer::Chunk& chunk : photons.chunks()) {
    EXPECT_EQ(chunk.first, next);
    EXPECT_EQ(chunk.count % kRow, 0U);
    EXPECT_LE(std::uint64_t{chunk.count} * sizeof(Photon), device().limits().maxStorageBufferRange);
    EXPECT_GE(chunk.buffer.size(), std::uint64_t{chunk.count} * sizeof(Photon));
    next += chunk.count;
  }
  EXPECT_EQ(next, kCount);
  EXPECT_EQ(photons.capacity(), kCount);
}

TEST_F(PhotonBufferTest, ARowThatNoBufferHoldsIsRefused) {
  // Vulkan counts a buffer's bytes in 32 bits here, so none holds as many photons.
  EXPECT_THROW(PhotonBuffer(device(), 0xFFFFFFF0U, 0xFFFFFFF0U), ResourceError);
}

}  // namespace
}  // namespace nephroid
