#include "gpu/commands.h"

#include <numeric>

#include "shaders/tests/gpu/double_words.comp.h"
#include "shaders/tests/gpu/triangle.frag.h"
#include "shaders/tests/gpu/triangle.vert.h"
#include "support/gpu_fixture.h"

namespace nephroid::gpu {
namespace {

class Commands : public testing::GpuTest {
 protected:
  static ComputePipeline makeScaler(std::uint32_t factor) {
    return ComputePipeline(device(),
                           {.shader = shaders::double_words_comp,
                            .bindings = {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}},
                            .push_bytes = 4,
                            .constants = {{0, factor}}},
                           "scale words");
  }
};

TEST_F(Commands, PassesSeeWhatEarlierPassesWrote) {
  std::vector<std::uint32_t> words(1000);
  std::iota(words.begin(), words.end(), 0U);
  CommandRecorder recorder(device());
  recorder.begin();
  const Buffer buffer =
      makeBuffer<std::uint32_t>(device(), recorder, words, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "words");
  const ComputePipeline twice = makeScaler(2), thrice = makeScaler(3);
  for (const ComputePipeline* pipeline : {&twice, &thrice, &twice})
    recorder.pass("scale", {Use(buffer, Access::kComputeWrite)}, [&](PassCommands& commands) {
      commands.bind(*pipeline);
      commands.bindResources({Bound(0, buffer)});
      commands.pushConstants(static_cast<std::uint32_t>(words.size()));
      commands.dispatch(groupsOf(static_cast<std::uint32_t>(words.size()), 64));
    });
  recorder.submit();
  recorder.wait();
  const std::vector<std::uint32_t> result = readBackAs<std::uint32_t>(device(), buffer);
  ASSERT_EQ(result.size(), words.size());
  for (std::size_t i = 0; i < words.size(); ++i) ASSERT_EQ(result[i], 12 * words[i]) << i;
}

TEST_F(Commands, PassesHaveAsManyGroupsAsEarlierPassesWrote) {
  // The first words are the number of groups, which a pass doubles before the next one asks for it.
  std::vector<std::uint32_t> words(1000, 1);
  CommandRecorder recorder(device());
  recorder.begin();
  const Buffer buffer = makeBuffer<std::uint32_t>(
      device(), recorder, words, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, "words");
  const ComputePipeline twice = makeScaler(2), thrice = makeScaler(3);
  const auto bind = [&](PassCommands& commands, const ComputePipeline& pipeline, std::size_t count) {
    commands.bind(pipeline);
    commands.bindResources({Bound(0, buffer)});
    commands.pushConstants(static_cast<std::uint32_t>(count));
  };
  recorder.pass("one word", {Use(buffer, Access::kComputeWrite)}, [&](PassCommands& commands) {
    bind(commands, twice, 1);
    commands.dispatch(1);
  });
  // The fourth to sixth word: a single group.
  recorder.pass("a group", {Use(buffer, Access::kDispatchWrite)}, [&](PassCommands& commands) {
    bind(commands, thrice, words.size());
    commands.dispatchIndirect(buffer, 3 * sizeof(std::uint32_t));
  });
  // Six in x, three in y and z by now: only those in x tell words apart.
  recorder.pass("all groups", {Use(buffer, Access::kDispatchRead)}, [&](PassCommands& commands) {
    bind(commands, twice, 0);
    commands.dispatchIndirect(buffer, 0);
  });
  recorder.submit();
  recorder.wait();
  const std::vector<std::uint32_t> result = readBackAs<std::uint32_t>(device(), buffer);
  EXPECT_EQ(result[0], 6U);
  for (std::size_t i = 1; i < words.size(); ++i) ASSERT_EQ(result[i], i < 64 ? 3U : 1U) << i;
}

TEST_F(Commands, TimesEveryPassByName) {
  CommandRecorder recorder(device());
  recorder.begin();
  const Buffer buffer(device(), 1 << 20, 0, MemoryIntent::kDevice, "bytes");
  recorder.pass("first", {Use(buffer, Access::kTransferWrite)}, [&](PassCommands& c) { c.fill(buffer, 1); });
  recorder.pass("second", {Use(buffer, Access::kTransferWrite)}, [&](PassCommands& c) { c.fill(buffer, 2); });
  recorder.submit();
  recorder.wait();
  ASSERT_EQ(recorder.passTimes().size(), 2U);
  EXPECT_EQ(recorder.passTimes()[0].name, "first");
  EXPECT_EQ(recorder.passTimes()[1].name, "second");
  for (const PassTime& time : recorder.passTimes()) EXPECT_GE(time.ms, 0.0);
}

TEST_F(Commands, DrawsIntoEachLayerOfATarget) {
  constexpr std::uint32_t kSize = 8, kLayers = 6;
  const Image target(device(),
                     {.format = VK_FORMAT_R32G32B32A32_SFLOAT,
                      .width = kSize,
                      .height = kSize,
                      .layers = kLayers,
                      .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                      .is_cube = true},
                     "target");
  const GraphicsPipeline pipeline(device(),
                                  {
                                      .vertex = shaders::triangle_vert,
                                      .fragment = shaders::triangle_frag,
                                      .push_bytes = sizeof(float),
                                      .colors = {{VK_FORMAT_R32G32B32A32_SFLOAT}},
                                  },
                                  "triangle");
  CommandRecorder recorder(device());
  recorder.begin();
  recorder.pass("draw", {Use(target, Access::kColorTarget, true)}, [&](PassCommands& commands) {
    commands.bind(pipeline);
    for (std::uint32_t layer = 0; layer < kLayers; ++layer) {
      commands.beginRendering({.colors = {{.image = target}}, .color_layer = layer});
      commands.pushConstants(1.0F + static_cast<float>(layer));
      commands.draw(3);
      commands.endRendering();
    }
  });
  recorder.submit();
  const std::vector<std::byte> bytes = readBack(device(), target);
  std::vector<float> texels(bytes.size() / sizeof(float));
  std::memcpy(texels.data(), bytes.data(), bytes.size());
  for (std::uint32_t layer = 0; layer < kLayers; ++layer) {
    const auto red = [&](std::uint32_t x, std::uint32_t y) { return texels[4 * ((layer * kSize + y) * kSize + x)]; };
    EXPECT_EQ(red(0, kSize - 1), 1.0F + static_cast<float>(layer));  // row 0 is on top
    EXPECT_EQ(red(kSize - 1, 0), 0.0F);
  }
}

TEST_F(Commands, ReusesTheMemoryOfWhatIsGone) {
  const VkDeviceSize before = device().memory().usedBytes();
  for (int i = 0; i < 100; ++i) {
    const Buffer buffer(device(), 3 << 20, 0, MemoryIntent::kDevice, "short-lived");
    EXPECT_GE(device().memory().usedBytes(), before + (3 << 20));
  }
  EXPECT_EQ(device().memory().usedBytes(), before);
}

}  // namespace
}  // namespace nephroid::gpu
