// The real program, drawing small pictures.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/process.h"
#include "core/image/image_io.h"

namespace nephroid::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// A render that takes a fraction of a second.
std::vector<std::string> smallRender(const std::string& output, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{"render", "builtin:ring", "--technique", "reference", "-o",        output,
                                     "--size", "32x24",        "--samples",   "1",         "--photons", "2000"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(Render, WritesPngAndSaysSoOnStderrOnly) {
  const TempFolder folder;
  const ProcessResult result = runNephroid(smallRender(folder.file("a.png")));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("wrote " + folder.file("a.png")));
  EXPECT_THAT(result.err, Not(HasSubstr("\x1b")));  // no progress bar where stderr is no terminal
  EXPECT_THAT(readText(folder.file("a.png")), StartsWith("\x89PNG"));
}

TEST(Render, ExrHoldsLayersAndWhatTheyWereMadeFrom) {
  const TempFolder folder;
  const ProcessResult result = runNephroid(smallRender(
      folder.file("a.exr"), {"--aov", "caustic,beauty,depth", "--seed", "7", "--material", "*:roughness=0.1"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const LayeredImage image = readExr(folder.file("a.exr"));
  EXPECT_EQ(image.width, 32);
  EXPECT_EQ(image.height, 24);
  for (const char* layer : {"beauty", "caustic", "depth"}) EXPECT_NE(image.find(layer), nullptr) << layer;
  EXPECT_EQ(image.metadata.at("scene"), "builtin:ring");
  EXPECT_EQ(image.metadata.at("technique"), "reference");
  EXPECT_EQ(image.metadata.at("seed"), "7");
  EXPECT_EQ(image.metadata.at("material"), "*:roughness=0.1");
  EXPECT_TRUE(image.metadata.contains("version"));
}

TEST(Render, EqualRunsWriteEqualFilesAndStatsDoNot) {
  const TempFolder folder;
  ASSERT_EQ(runNephroid(smallRender(folder.file("a.exr"), {"--threads", "1"})).exit_code, 0);
  ASSERT_EQ(runNephroid(smallRender(folder.file("b.exr"), {"--threads", "2"})).exit_code, 0);
  ASSERT_EQ(runNephroid(smallRender(folder.file("c.exr"), {"--stats"})).exit_code, 0);
  EXPECT_TRUE(readText(folder.file("a.exr")) == readText(folder.file("b.exr")));
  EXPECT_TRUE(readExr(folder.file("c.exr")).metadata.contains("stats.rays"));
  EXPECT_FALSE(readExr(folder.file("a.exr")).metadata.contains("stats.rays"));
}

TEST(Render, PngOfSeveralLayersGoesToOneFileEach) {
  const TempFolder folder;
  const ProcessResult result =
      runNephroid(smallRender(folder.file("a.png"), {"--aov", "beauty,caustic,normal,depth,id,position,albedo"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* file : {"a.png", "a.caustic.png", "a.normal.png", "a.depth.png", "a.id.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder.file(file))) << file;
    EXPECT_THAT(result.err, HasSubstr("wrote " + folder.file(file)));
  }
}

TEST(Render, PngOfOneOtherLayerIsThatLayer) {
  const TempFolder folder;
  ASSERT_EQ(runNephroid(smallRender(folder.file("a.png"), {"--aov", "normal"})).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder.file("a.png")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.normal.png")));
}

TEST(Render, FramesAreNumberedAndMove) {
  const TempFolder folder;
  const ProcessResult result =
      runNephroid({"render", "builtin:pool", "--technique", "reference", "-o", folder.file("p.exr"), "--frames", "1..2",
                   "--fps", "2", "--size", "16x12", "--samples", "1", "--photons", "500"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(readExr(folder.file("p_0001.exr")).metadata.at("time"), "0.5");
  EXPECT_EQ(readExr(folder.file("p_0002.exr")).metadata.at("time"), "1");
  EXPECT_FALSE(std::filesystem::exists(folder.file("p.exr")));
}

TEST(Render, JsonGoesToStdoutAlone) {
  const TempFolder folder;
  const ProcessResult result = runNephroid(smallRender(folder.file("a.exr"), {"--json", "--verbose"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["width"], 32);
  EXPECT_EQ(json["files"][0], folder.file("a.exr"));
  EXPECT_FALSE(json["ledgers"].empty());
  EXPECT_THAT(result.err, HasSubstr("rays"));
}

TEST(Render, CommandLineWinsOverStateFile) {
  const TempFolder folder;
  writeText(
      folder.file("s.json"),
      R"({"scene": "builtin:ring", "technique": "reference", "size": "8x6", "samples": 1, "photons": "500", "seed": 5, "half": true})");
  const ProcessResult result =
      runNephroid({"render", "-o", folder.file("a.exr"), "--state", folder.file("s.json"), "--size", "10x6"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const LayeredImage image = readExr(folder.file("a.exr"));
  EXPECT_EQ(image.width, 10);
  EXPECT_EQ(image.metadata.at("seed"), "5");
}

TEST(Render, BadStateFileIsBadInputThatNamesTheKey) {
  const TempFolder folder;
  const std::string state = folder.file("s.json");
  for (const auto& [text, found] : std::vector<std::pair<std::string, std::string>>{{"{", "not valid JSON"},
                                                                                    {"[1]", "array"},
                                                                                    {R"({"sampels": 3})", "samples"},
                                                                                    {R"({"size": 3})", "size"},
                                                                                    {R"({"fps": -3})", "fps"}}) {
    writeText(state, text);
    const ProcessResult result = runNephroid({"render", "builtin:ring", "-o", folder.file("a.png"), "--state", state});
    EXPECT_EQ(result.exit_code, 3) << text;
    EXPECT_THAT(result.err, HasSubstr(state));
    EXPECT_THAT(result.err, HasSubstr(found));
  }
}

TEST(Render, TargetErrorEndsTheRenderAndErrorsAreLayers) {
  const TempFolder folder;
  const ProcessResult result =
      runNephroid({"render", "builtin:slab", "-o", folder.file("a.exr"), "--size", "16x12", "--target-error", "0.05",
                   "--photons", "200k", "--aov", "direct,direct_error,specular_caustic_bias"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const LayeredImage image = readExr(folder.file("a.exr"));
  ASSERT_NE(image.find("direct_error"), nullptr);
  EXPECT_NE(image.find("specular_caustic_bias"), nullptr);
  EXPECT_LE(std::stod(image.metadata.at("estimated_relmse.direct")), 0.05);
  EXPECT_GT(std::stod(image.metadata.at("estimated_relmse.direct")), 0.0);
}

TEST(Render, TargetErrorOfATechniqueThatKnowsNoneIsWrongUsage) {
  for (const std::string& technique : {std::string("reference"), std::string("caustic-map")}) {
    if (runNephroid({"techniques", technique}).exit_code != 0) continue;  // built without Vulkan
    const TempFolder folder;
    const ProcessResult result = runNephroid(
        smallRender(folder.file("a.exr"), {"--technique", technique, "--target-error", "0.1", "--aov", "normal"}));
    EXPECT_EQ(result.exit_code, 2) << technique;
    EXPECT_EQ(countLines(result.err), 1) << result.err;
  }
}

TEST(Render, MissingAndBrokenScenesAreBadInput) {
  const TempFolder folder;
  writeText(folder.file("broken.glb"), "glTF but not really");
  for (const std::string& scene : {folder.file("missing.glb"), folder.file("broken.glb")}) {
    const ProcessResult result = runNephroid({"render", scene, "-o", folder.file("a.png")});
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_THAT(result.err, HasSubstr(scene));
    EXPECT_EQ(countLines(result.err), 1) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder.file("a.png")));
  }
}

TEST(Render, UnwritablePathFailsBeforeTheWork) {
  const auto start = std::chrono::steady_clock::now();
  const ProcessResult result =
      runNephroid({"render", "builtin:ring", "-o", "/nonexistent/folder/a.png", "--seconds", "100"});
  EXPECT_EQ(result.exit_code, 5) << result.err;
  EXPECT_THAT(result.err, HasSubstr("/nonexistent/folder"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST(Render, FolderAsOutputIsRefused) {
  const TempFolder folder;
  std::filesystem::create_directory(folder.file("a.png"));
  EXPECT_EQ(runNephroid(smallRender(folder.file("a.png"))).exit_code, 5);
}

TEST(Output, ToAFullDiskIsExitCodeFive) {
  const ProcessResult result = runNephroid({"scenes"}, {.stdout_path = "/dev/full"});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_THAT(result.err, HasSubstr("standard output"));
  EXPECT_EQ(countLines(result.err), 1);
}

TEST(Output, ToAReaderThatWentAwayIsNoError) {
  const ProcessResult result = runProcess(
      {"bash", "-c", "set -o pipefail; " NEPHROID_PROGRAM " scenes | true; " NEPHROID_PROGRAM " manual | head -n 1"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
}

/// The delay lets the signal meet the render and not the start, also under sanitizers.
void interruptAfter(pid_t process, std::chrono::milliseconds delay, int signal) {
  std::this_thread::sleep_for(delay);
  kill(process, signal);
}

TEST(Interrupt, KeepsThePictureAsFarAsItCame) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const TempFolder folder;
    // One layer that is seen at once, however slow the machine.
    const ProcessResult result =
        runNephroid({"render", "builtin:slab", "--technique", "reference", "-o", folder.file("a.exr"), "--size",
                     "64x48", "--seconds", "600", "--aov", "direct"},
                    {.while_running = [signal](pid_t process) {
                      interruptAfter(process, std::chrono::milliseconds(4000), signal);
                    }});
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_EQ(result.out, "");
    ASSERT_TRUE(std::filesystem::exists(folder.file("a.exr"))) << result.err;
    EXPECT_NE(readExr(folder.file("a.exr")).find("direct"), nullptr);
    // No temporary file is left beside it.
    const std::filesystem::directory_iterator files(folder.path());
    EXPECT_EQ(std::distance(files, std::filesystem::directory_iterator()), 1);
  }
}

/// A render of some seconds, kept twice a second and oftener.
std::vector<std::string> keptRender(const std::string& output, const std::string& checkpoint) {
  return {"render",
          "builtin:sphere",
          "-o",
          output,
          "--size",
          "96x72",
          "--samples",
          "48",
          "--photons",
          "1M",
          "--aov",
          "beauty,specular_caustic",
          "--set",
          "max-bounces=12",
          "--checkpoint",
          checkpoint,
          "--checkpoint-every",
          "0.1"};
}

/// Waits until the file is there and newer than it was, or the time is over in which it should be.
void waitForNewer(const std::string& file, std::filesystem::file_time_type than) {
  std::error_code missing;
  for (int i = 0; i < 6000; ++i) {
    const auto written = std::filesystem::last_write_time(file, missing);
    if (!missing && written > than) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

TEST(Checkpoint, ARenderThatWasKilledGoesOnToTheSamePixels) {
  const TempFolder folder;
  const std::string checkpoint = folder.file("c.checkpoint");
  const ProcessResult whole = runNephroid(keptRender(folder.file("whole.exr"), folder.file("whole.checkpoint")));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  std::filesystem::file_time_type written = std::filesystem::file_time_type::min();
  for (int i = 0; i < 2; ++i) {
    const ProcessResult killed =
        runNephroid(keptRender(folder.file("a.exr"), checkpoint), {.while_running = [&](pid_t process) {
                      waitForNewer(checkpoint, written);
                      kill(process, SIGKILL);
                    }});
    written = std::filesystem::last_write_time(checkpoint);
    ASSERT_EQ(killed.signal, SIGKILL) << killed.err;
    ASSERT_FALSE(std::filesystem::exists(folder.file("a.exr")));
  }
  std::vector<std::string> arguments = keptRender(folder.file("a.exr"), checkpoint);
  arguments.emplace_back("--verbose");
  const ProcessResult resumed = runNephroid(arguments);
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_THAT(resumed.err, HasSubstr("went on from " + checkpoint));
  EXPECT_TRUE(readText(folder.file("a.exr")) == readText(folder.file("whole.exr")));
}

TEST(Checkpoint, OfAnotherRenderIsBadInput) {
  const TempFolder folder;
  const std::vector<std::string> kept{"--checkpoint", folder.file("c")};
  ASSERT_EQ(runNephroid(smallRender(folder.file("a.png"), kept)).exit_code, 0);
  const ProcessResult other =
      runNephroid(smallRender(folder.file("b.png"), {"--checkpoint", folder.file("c"), "--seed", "3"}));
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_THAT(other.err, HasSubstr("its seed is 0, here it is 3"));
  EXPECT_EQ(countLines(other.err), 1) << other.err;
  EXPECT_FALSE(std::filesystem::exists(folder.file("b.png")));
}

TEST(Checkpoint, FullDiskIsExitCodeFiveAndLosesNoPicture) {
  // Files may have 16 blocks of 1024 bytes: enough for a picture of 32 x 24, too few for its sums.
  const TempFolder folder;
  std::string command = "trap '' XFSZ; ulimit -f 16; exec " NEPHROID_PROGRAM;
  for (const std::string& argument : smallRender(folder.file("a.png"), {"--checkpoint", folder.file("c")}))
    command += " '" + argument + "'";
  const ProcessResult result = runProcess({"bash", "-c", command});
  EXPECT_EQ(result.exit_code, 5) << result.err;
  EXPECT_THAT(result.err, HasSubstr("error: " + folder.file("c")));
  EXPECT_TRUE(std::filesystem::exists(folder.file("a.png")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("c")));
}

TEST(Checkpoint, OfFramesIsOneFileEach) {
  const TempFolder folder;
  ASSERT_EQ(runNephroid(smallRender(folder.file("a.png"), {"--frames", "1..2", "--checkpoint", folder.file("c.ckpt")}))
                .exit_code,
            0);
  EXPECT_TRUE(std::filesystem::exists(folder.file("c_0001.ckpt")));
  EXPECT_TRUE(std::filesystem::exists(folder.file("c_0002.ckpt")));
}

TEST(Info, DescribesTheSceneOnStdout) {
  const ProcessResult text = runNephroid({"info", "builtin:ring"});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("generator"));
  const ProcessResult json = runNephroid({"info", "builtin:ring", "--json"});
  EXPECT_EQ(json.exit_code, 0);
  EXPECT_FALSE(nlohmann::json::parse(json.out).empty());
}

}  // namespace
}  // namespace nephroid::test
