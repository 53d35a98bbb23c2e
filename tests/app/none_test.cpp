// The real program with real-time techniques: what needs a Vulkan device.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/process.h"
#include "core/image/image_io.h"

namespace nephroid::test {
namespace {

using ::testing::HasSubstr;

/// The pipelines of tests are kept apart from the user's.
ProcessResult runApart(const TempFolder& folder, const std::vector<std::string>& arguments) {
  return runNephroid(arguments, {.environment = {"XDG_CACHE_HOME=" + folder.file("cache")}});
}

TEST(NoneTechnique, DrawsABuiltInScene) {
  const TempFolder folder;
  const ProcessResult result = runApart(folder, {"render", "builtin:ring", "--technique", "none", "--size", "64x48",
                                                 "-o", folder.file("x.exr"), "--aov", "beauty,caustic", "--verbose"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("note: caustic is black"));
  const LayeredImage image = readExr(folder.file("x.exr"));
  EXPECT_EQ(image.metadata.at("technique"), "none");
  EXPECT_EQ(image.metadata.at("not_made"), "caustic");
  EXPECT_NE(image.metadata.at("device"), "cpu");
}

TEST(NoneTechnique, DeviceThatIsNotThereIsExitCodeFour) {
  const TempFolder folder;
  const ProcessResult result = runApart(folder, {"render", "builtin:ring", "--technique", "none", "--size", "64x48",
                                                 "-o", folder.file("x.exr"), "--device", "99"});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.err, HasSubstr("error: --device 99"));
  EXPECT_EQ(countLines(result.err), 1) << result.err;
}

TEST(NoneTechnique, WithoutVulkanIsWrongUsage) {
  const TempFolder folder;
  const ProcessResult result = runApart(
      folder, {"render", "builtin:ring", "--technique", "none", "-o", folder.file("x.exr"), "--device", "cpu"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("needs a Vulkan device"));
  EXPECT_EQ(countLines(result.err), 1) << result.err;
}

TEST(NoneTechnique, BenchTellsTimeOfEachPassOfAFrame) {
  const TempFolder folder;
  const ProcessResult result = runApart(folder, {"bench", "builtin:ring", "--technique", "none", "--repeats", "2",
                                                 "--warmup", "0", "--size", "16x12", "--samples", "2", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out)["results"][0];
  EXPECT_NE(json["device"], "cpu");
  bool found = false;
  for (const auto& measurement : json["measurements"]) {
    if (measurement["name"] != "shade / frame") continue;
    found = true;
    EXPECT_EQ(measurement["unit"], "ms");
    EXPECT_EQ(measurement["values"].size(), 2U);
  }
  EXPECT_TRUE(found) << result.out;
}

TEST(DefaultTechnique, IsCausticMapOnAVulkanDevice) {
  const TempFolder folder;
  const ProcessResult result = runApart(
      folder, {"render", "builtin:ring", "--size", "16x12", "--samples", "1", "-o", folder.file("x.exr"), "--verbose"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const LayeredImage image = readExr(folder.file("x.exr"));
  EXPECT_EQ(image.metadata.at("technique"), "caustic-map");
  EXPECT_NE(image.metadata.at("device"), "cpu");
  EXPECT_THAT(result.err, HasSubstr("caustic-map"));
}

TEST(DefaultTechnique, IsTheReferenceForWhatOnlyItHas) {
  const TempFolder folder;
  const ProcessResult result =
      runApart(folder, {"render", "builtin:ring", "--size", "16x12", "--samples", "4", "--photons", "1000", "--aov",
                        "beauty,beauty_error", "-o", folder.file("x.exr")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(readExr(folder.file("x.exr")).metadata.at("technique"), "reference");
}

TEST(DefaultTechnique, IsTheReferenceWithoutVulkan) {
  const TempFolder folder;
  const ProcessResult result = runApart(folder, {"render", "builtin:ring", "--size", "16x12", "--samples", "1",
                                                 "--photons", "1000", "--device", "cpu", "-o", folder.file("x.exr")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(readExr(folder.file("x.exr")).metadata.at("technique"), "reference");
}

TEST(BenchError, ComparesWhatDrawsCausticsInRealTime) {
  const TempFolder folder;
  const ProcessResult result = runApart(folder, {"bench", "--error", "builtin:slab", "--size", "32x24", "--samples",
                                                 "1", "--reference-photons", "200k", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json results = nlohmann::json::parse(result.out)["results"];
  ASSERT_EQ(results.size(), 2U) << result.out;  // `none` draws none
  EXPECT_EQ(results[1]["technique"], "caustic-map");
  EXPECT_NE(results[1]["device"], "cpu");
  EXPECT_NEAR(results[1]["energy"].get<double>(), 1.0, 0.03);
  EXPECT_LT(results[1]["relmse"].get<double>(), 0.2);
  EXPECT_LT(results[1]["lost"].get<double>(), 0.01);
}

}  // namespace
}  // namespace nephroid::test
