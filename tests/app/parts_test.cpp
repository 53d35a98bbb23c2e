// The functions behind the program that need no process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cstring>

#include "api/display.h"
#include "app/cli/bench_speed.h"
#include "app/cli/devices.h"
#include "app/cli/help.h"
#include "app/cli/memory.h"
#include "app/cli/options.h"
#include "app/cli/picture.h"
#include "app/cli/plot_svg.h"
#include "app/cli/progress_bar.h"
#include "app/cli/terminal.h"
#include "nephroid/error.h"

namespace nephroid::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(ParseCount, ReadsDigitsExponentsAndSuffixes) {
  EXPECT_EQ(parseCount("--n", "64"), 64U);
  EXPECT_EQ(parseCount("--n", "1e6"), 1'000'000U);
  EXPECT_EQ(parseCount("--n", "500k"), 500'000U);
  EXPECT_EQ(parseCount("--n", "2.5M"), 2'500'000U);
  EXPECT_EQ(parseCount("--n", "0"), 0U);
}

TEST(ParseCount, RefusesWhatIsNoCount) {
  for (const char* text : {"", "k", "-1", "1.5", "1e300", "nan", "inf", "12x", " 1", "0x10"})
    EXPECT_THROW(parseCount("--n", text), UsageError) << text;
}

TEST(ParseSize, ReadsWidthAndHeight) {
  EXPECT_EQ(parseSize("--size", "1024x768").width, 1024);
  EXPECT_EQ(parseSize("--size", "1024x768").height, 768);
  for (const char* text : {"", "x", "10", "10x", "x10", "10x10x", "0x1", "1x-1", "20000x1", "1.5x2"})
    EXPECT_THROW(parseSize("--size", text), UsageError) << text;
}

TEST(Describe, HasOneFormAndLeavesOutWhatThereIsNot) {
  EXPECT_EQ(describe({"Text.", "1", "0 to 2", "m"}), "Text. [default: 1; range: 0 to 2; unit: m]");
  EXPECT_EQ(describe({"Text.", "1", "", ""}), "Text. [default: 1]");
  EXPECT_EQ(describe({"Text.", "", "", ""}), "Text.");
}

TEST(WrapText, KeepsLinesWithinTheWidthAndLosesNoWord) {
  EXPECT_EQ(wrapText("aa bb cc dd", 2, 7), "  aa bb\n  cc dd\n");
  EXPECT_EQ(wrapText("a-word-longer-than-the-line b", 0, 5), "a-word-longer-than-the-line\nb\n");
  EXPECT_EQ(wrapText("a bb|cc|dd|ee f", 0, 6), "a bb|\ncc|dd|\nee f\n");
}

TEST(FormatProgress, TellsFractionElapsedAndRest) {
  const std::string line = formatProgress("frame 1/2", 0.25, "caustic", 10, 200);
  EXPECT_THAT(line, HasSubstr("frame 1/2 [######                  ]  25 %"));
  EXPECT_THAT(line, HasSubstr("elapsed 10 s, left 30 s"));
  EXPECT_THAT(line, HasSubstr("caustic"));
}

TEST(FormatProgress, FitsTheTerminalAndGuessesNothingAtTheStart) {
  EXPECT_LT(formatProgress("", 0.5, std::string(500, 'x'), 10, 80).size(), 80U);
  EXPECT_THAT(formatProgress("", 0.0, "", 3, 80), Not(HasSubstr("left")));
  EXPECT_THAT(formatProgress("", 0.5, "", 4000, 80), HasSubstr("1 h 06 min"));
}

TEST(PictureFiles, PutsBeautyOrTheFirstLayerUnderTheGivenName) {
  EXPECT_THAT(pictureFiles("d/a.png", {"beauty", "caustic"}), ElementsAre("d/a.png", "d/a.caustic.png"));
  EXPECT_THAT(pictureFiles("a.png", {"caustic", "beauty"}), ElementsAre("a.caustic.png", "a.png"));
  EXPECT_THAT(pictureFiles("a.png", {"direct", "caustic"}), ElementsAre("a.png", "a.caustic.png"));
  EXPECT_THAT(pictureFiles("a.EXR", {"beauty", "caustic"}), ElementsAre("a.EXR", "a.EXR"));
  EXPECT_THROW(pictureFiles("a", {"beauty"}), UsageError);
}

TEST(ToOneLine, FoldsBlanksAndBreaks) { EXPECT_EQ(toOneLine(" a\n\n b\tc \n"), "a b c"); }

TEST(Median, IsTheMiddleAndSpreadHalfTheRange) {
  EXPECT_EQ(computeMedian({3, 1, 2}), 2);
  EXPECT_EQ(computeMedian({4, 1, 2, 3}), 2.5);
  EXPECT_EQ(computeMedian({}), 0);
  EXPECT_DOUBLE_EQ(computeSpread({1, 2, 3}), 0.5);
  EXPECT_EQ(computeSpread({5}), 0);
}

TEST(PeakMemory, SeesAnAllocationAndForgetsItWhenReset) {
  resetPeakMemory();
  const double before = readPeakMemory();
  // Not from the heap: what is freed there may be kept.
  constexpr std::size_t kBytes = std::size_t{64} << 20;
  void* block = mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(block, MAP_FAILED);
  std::memset(block, 1, kBytes);
  munmap(block, kBytes);
  const double with = readPeakMemory();
  EXPECT_GT(with, before + 50);
  resetPeakMemory();
  EXPECT_LT(readPeakMemory(), with - 50);
}

TEST(CheckMemory, RefusesWhatCannotFitAndSaysWhatToLower) {
  EXPECT_NO_THROW(checkMemory(10, 10));
  EXPECT_THROW(checkMemory(11, 10), ResourceError);
  EXPECT_GT(readAvailableMemory(), 1);
}

gpu::DeviceInfo makeDevice(std::string name, std::string kind) {
  gpu::DeviceInfo device;
  device.name = std::move(name);
  device.kind = std::move(kind);
  device.driver = "Maker 1.2";
  device.api_version = "1.3.230";
  device.memory_bytes = std::uint64_t{3} << 29;
  return device;
}

TEST(FormatDevices, HasABlockForEachDeviceAndALastLineForAuto) {
  gpu::DeviceInfo good = makeDevice("Fast One", "discrete GPU");
  good.float_atomics = true;
  good.timestamp_period_ns = 2;
  gpu::DeviceInfo poor = makeDevice("Slow One", "integrated GPU");
  poor.memory_bytes = std::uint64_t{256} << 20;
  poor.missing = {"multiview", "VK_KHR_push_descriptor"};
  const gpu::DeviceSurvey survey{{poor, good}, 1, "the only discrete GPU"};
  EXPECT_EQ(formatDevices(survey), R"(0  Slow One
   kind     integrated GPU
   driver   Maker 1.2
   Vulkan   1.3.230
   memory   256 MiB
   usable   no, it lacks multiview, VK_KHR_push_descriptor

1  Fast One
   kind     discrete GPU
   driver   Maker 1.2
   Vulkan   1.3.230
   memory   1.5 GiB
   usable   yes
   extras   float atomics, timestamps (no 64-bit atomics, no ray tracing pipeline)

auto takes 1: the only discrete GPU
)");
}

TEST(FormatDevices, TellsAllAndNoExtras) {
  gpu::DeviceInfo device = makeDevice("One", "CPU");
  EXPECT_THAT(
      formatDevices({{device}, 0, "why"}),
      HasSubstr("extras   none (no float atomics, no 64-bit atomics, no ray tracing pipeline, no timestamps)\n"));
  device.float_atomics = device.int64_atomics = device.ray_tracing_pipeline = true;
  device.timestamp_period_ns = 1;
  EXPECT_THAT(formatDevices({{device}, 0, "why"}),
              HasSubstr("extras   float atomics, 64-bit atomics, ray tracing pipeline, timestamps\n"));
}

TEST(FormatDevices, SaysNothingOfTheDriverThatWasNotAsked) {
  gpu::DeviceInfo old = makeDevice("Old", "discrete GPU");
  old.driver = "";
  old.missing = {"Vulkan 1.3 (has 1.2.0)"};
  const std::string text = formatDevices({{old}, std::nullopt, "no usable Vulkan device; use --device cpu"});
  EXPECT_THAT(text, Not(HasSubstr("driver")));
  EXPECT_THAT(text, Not(HasSubstr("extras")));
  EXPECT_THAT(text, HasSubstr("usable   no, it lacks Vulkan 1.3 (has 1.2.0)\n"));
  EXPECT_THAT(text, ::testing::EndsWith("\nauto takes none: no usable Vulkan device; use --device cpu\n"));
}

TEST(FormatDevices, IsOneLineWhereThereIsNoDevice) {
  EXPECT_EQ(formatDevices({{}, std::nullopt, "no Vulkan\nloader"}), "only the CPU: no Vulkan loader\n");
}

TEST(DevicesToJson, HasEveryFieldAndTheChoice) {
  gpu::DeviceInfo device = makeDevice("One", "virtual GPU");
  device.missing = {"multiview"};
  device.ray_tracing_pipeline = true;
  device.timestamp_period_ns = 2.5F;
  const nlohmann::ordered_json json = devicesToJson({{device}, std::nullopt, "none fits"});
  EXPECT_EQ(json, nlohmann::ordered_json::parse(R"({
    "devices": [{"device": 0, "name": "One", "kind": "virtual GPU", "driver": "Maker 1.2", "vulkan": "1.3.230",
      "memory_bytes": 1610612736, "usable": false, "missing": ["multiview"], "float_atomics": false,
      "int64_atomics": false, "ray_tracing_pipeline": true, "timestamps": true, "timestamp_period_ns": 2.5}],
    "auto": null, "reason": "none fits"})"));
  EXPECT_EQ(devicesToJson({{device}, 0, "asked for"})["auto"], 0);
}

LayeredImage makeLayer(const std::string& name, int channels, std::vector<float> pixels) {
  const int width = static_cast<int>(pixels.size()) / channels;
  LayeredImage image{.width = width, .height = 1};
  Image layer(width, 1, channels);
  layer.pixels = std::move(pixels);
  image.layers.push_back({name, layer});
  return image;
}

TEST(DisplayLayer, ShowsNormalsAroundGreyAndNearWhite) {
  const Image normal = displayLayer(makeLayer("normal", 3, {0, 0, 1, -1, 0, 0}), "normal", {});
  EXPECT_EQ(normal.rgb(0, 0), vec3(0.5F, 0.5F, 1.0F));
  EXPECT_EQ(normal.rgb(1, 0), vec3(0.0F, 0.5F, 0.5F));
  const Image depth = displayLayer(makeLayer("depth", 1, {2, 4, kInfinity, 0}), "depth", {});
  EXPECT_FLOAT_EQ(depth.rgb(0, 0).x, 1.0F);
  EXPECT_NEAR(depth.rgb(1, 0).x, 0.1F, 1e-6F);
  EXPECT_EQ(depth.rgb(2, 0), vec3(0));
  EXPECT_EQ(depth.rgb(3, 0), vec3(0));
}

TEST(DisplayLayer, ShowsIrradianceAsTheRadianceOfWhitePaper) {
  const DisplayOptions plain{.exposure_ev = 0.0F};
  const Image radiance = displayLayer(makeLayer("beauty", 3, {0.5F, 0.25F, 0.125F}), "beauty", plain);
  const Image irradiance =
      displayLayer(makeLayer("irradiance", 3, {0.5F * kPi, 0.25F * kPi, 0.125F * kPi}), "irradiance", plain);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(irradiance.at(0, 0)[c], radiance.at(0, 0)[c], 1e-6F);
}

TEST(DisplayLayer, GivesNeighbouringIdsDistinctColours) {
  const Image id = displayLayer(makeLayer("id", 1, {0, 1, 2, 3}), "id", {});
  EXPECT_EQ(id.rgb(0, 0), vec3(0));
  EXPECT_GT(length(id.rgb(1, 0) - id.rgb(2, 0)), 0.1F);
  EXPECT_GT(length(id.rgb(2, 0) - id.rgb(3, 0)), 0.1F);
}

TEST(DrawPlots, PlacesPowersOfTenOnTheGridAndLeavesOutWhatHasNoLogarithm) {
  const PlotPanel panel{"a <scene>", "s", "L1", {{"one", {{1.0, 0.1}, {10.0, 0.01}, {2.0, 0.0}, {-1.0, 0.5}}}}};
  const std::string svg = drawPlots({{panel}});
  EXPECT_THAT(svg, HasSubstr("a &lt;scene&gt;"));
  // The axes are one decade each, so the points are the corners: from the upper left to the lower right.
  EXPECT_THAT(svg, HasSubstr("<polyline points=\"54.0,28.0 288.0,198.0 \""));
  std::size_t circles = 0;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) ++circles;
  EXPECT_EQ(circles, 2U);
}

TEST(DrawPlots, GivesACurveOfOneNameOneColour) {
  const PlotPanel first{"1", "s", "L1", {{"a", {{1.0, 1.0}}}, {"b", {{2.0, 2.0}}}}},
      second{"2", "s", "L1", {{"b", {{1.0, 1.0}}}}};
  const std::string svg = drawPlots({{first, second}});
  const auto countOf = [&](const std::string& text) {
    int count = 0;
    for (std::size_t at = svg.find(text); at != std::string::npos; at = svg.find(text, at + 1)) ++count;
    return count;
  };
  EXPECT_EQ(countOf("stroke=\"#0072b2\""), 2);  // a curve and its line in the legend
  EXPECT_EQ(countOf("stroke=\"#d55e00\""), 3);  // two curves
}

}  // namespace
}  // namespace nephroid::cli
