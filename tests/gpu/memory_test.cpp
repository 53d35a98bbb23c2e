#include "gpu/memory.h"

#include "nephroid/error.h"
#include "support/gpu_fixture.h"

namespace nephroid::gpu {
namespace {

class Memory : public testing::GpuTest {
 protected:
  static Allocation allocate(VkDeviceSize size, VkDeviceSize alignment = 256) {
    return device().memory().allocate({size, alignment, ~0U}, MemoryIntent::kUpload, true, "test");
  }
};

TEST_F(Memory, PiecesOfABlockDoNotOverlap) {
  std::vector<Allocation> pieces;
  for (int i = 0; i < 50; ++i) pieces.push_back(allocate(1000 + 37 * i));
  // Holes, then pieces that may fill them.
  for (std::size_t i = 0; i < pieces.size(); i += 3) pieces[i] = Allocation();
  for (int i = 0; i < 30; ++i) pieces.push_back(allocate(500 + 91 * i));
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!pieces[i].mapped()) continue;
    EXPECT_EQ(pieces[i].offset() % 256, 0U);
    std::fill_n(pieces[i].mapped(), 500, static_cast<std::byte>(i));
  }
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (int k = 0; pieces[i].mapped() && k < 500; ++k) ASSERT_EQ(pieces[i].mapped()[k], static_cast<std::byte>(i));
}

TEST_F(Memory, TellsWhatWasTooLargeAndWhatToDo) {
  try {
    const Allocation huge =
        device().memory().allocate({VkDeviceSize{1} << 50, 256, ~0U}, MemoryIntent::kDevice, true, "photon map");
    FAIL() << "a petabyte was allocated";
  } catch (const ResourceError& error) {
    EXPECT_NE(std::string(error.what()).find("photon map"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("lower"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace nephroid::gpu
