// `nephroid compare` on pictures whose differences are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "app/process.h"
#include "core/image/image_io.h"

namespace nephroid::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// Layers of one constant colour each.
void writeConstant(const std::string& path, int width, int height,
                   const std::vector<std::pair<std::string, float>>& layers) {
  LayeredImage image{.width = width, .height = height};
  for (const auto& [name, value] : layers) image.layers.push_back({name, Image(width, height, 3, value)});
  writeExr(path, image);
}

TEST(Compare, TellsMeansRatioAndError) {
  const TempFolder folder;
  writeConstant(folder.file("a.exr"), 4, 3, {{"beauty", 3.0F}});
  writeConstant(folder.file("b.exr"), 4, 3, {{"beauty", 2.0F}});
  const ProcessResult result =
      runNephroid({"compare", folder.file("a.exr"), folder.file("b.exr"), "--metric", "rmse", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_DOUBLE_EQ(json["ratio"][1].get<double>(), 1.5);
  EXPECT_NEAR(json["metrics"]["rmse"].get<double>(), 1.0, 1e-6);
  EXPECT_EQ(json["pixels"], 12);
  EXPECT_THAT(runNephroid({"compare", folder.file("a.exr"), folder.file("b.exr")}).out, HasSubstr("ratio"));
}

TEST(Compare, SumsLayersAndTakesAnotherOfTheReference) {
  const TempFolder folder;
  writeConstant(folder.file("a.exr"), 4, 3, {{"direct", 1.0F}, {"caustic", 2.0F}});
  writeConstant(folder.file("b.exr"), 4, 3, {{"beauty", 3.0F}});
  const ProcessResult result = runNephroid({"compare", folder.file("a.exr"), folder.file("b.exr"), "--layer",
                                            "direct+caustic", "--reference-layer", "beauty", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_DOUBLE_EQ(nlohmann::json::parse(result.out)["ratio"][0].get<double>(), 1.0);
}

TEST(Compare, CountsOnlyPixelsWhereTheMaskIsWhite) {
  const TempFolder folder;
  LayeredImage image{.width = 2, .height = 1};
  image.layers.push_back({"beauty", Image(2, 1, 3, 1.0F)});
  image.layers[0].image.setRgb(1, 0, vec3(9.0F));
  writeExr(folder.file("a.exr"), image);
  writeConstant(folder.file("b.exr"), 2, 1, {{"beauty", 1.0F}});
  Image mask(2, 1, 3, 1.0F);
  mask.setRgb(1, 0, vec3(0.5F));
  writePng(folder.file("m.png"), mask);
  const ProcessResult result =
      runNephroid({"compare", folder.file("a.exr"), folder.file("b.exr"), "--mask", folder.file("m.png"), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["pixels"], 1);
  EXPECT_DOUBLE_EQ(json["mean"][0].get<double>(), 1.0);
}

TEST(Compare, OtherSizeOrMissingLayerIsBadInput) {
  const TempFolder folder;
  writeConstant(folder.file("a.exr"), 4, 3, {{"beauty", 1.0F}});
  writeConstant(folder.file("b.exr"), 4, 4, {{"beauty", 1.0F}});
  const ProcessResult size = runNephroid({"compare", folder.file("a.exr"), folder.file("b.exr")});
  EXPECT_EQ(size.exit_code, 3);
  EXPECT_THAT(size.err, HasSubstr("4x3"));
  EXPECT_THAT(size.err, HasSubstr("4x4"));
  const ProcessResult layer =
      runNephroid({"compare", folder.file("a.exr"), folder.file("a.exr"), "--layer", "caustic"});
  EXPECT_EQ(layer.exit_code, 3);
  EXPECT_THAT(layer.err, HasSubstr(folder.file("a.exr")));
  EXPECT_THAT(layer.err, HasSubstr("caustic"));
  EXPECT_EQ(runNephroid({"compare", folder.file("a.exr"), folder.file("missing.exr")}).exit_code, 3);
}

// Twice and four times white: on a screen all is white, in the scene they differ.
TEST(Compare, FlipTakesPngsAsShownAndExrsAsLight) {
  const TempFolder folder;
  writeConstant(folder.file("a.exr"), 4, 3, {{"beauty", 4.0F}});
  writeConstant(folder.file("b.exr"), 4, 3, {{"beauty", 2.0F}});
  writePng(folder.file("a.png"), Image(4, 3, 3, 1.0F));
  writePng(folder.file("b.png"), Image(4, 3, 3, 1.0F));
  const auto flip = [&](const char* image, const char* reference) {
    const ProcessResult result =
        runNephroid({"compare", folder.file(image), folder.file(reference), "--metric", "flip", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  };
  EXPECT_EQ(flip("a.png", "b.png")["metrics"]["flip"], 0.0);
  EXPECT_EQ(flip("a.png", "b.png")["flip"]["kind"], "LDR");
  EXPECT_GT(flip("a.exr", "b.exr")["metrics"]["flip"], 0.05);
  EXPECT_EQ(flip("a.exr", "b.exr")["flip"]["kind"], "HDR");
  EXPECT_EQ(flip("a.png", "b.exr")["flip"]["kind"], "HDR");
}

TEST(Compare, FlipLooksFromTheDistanceThatIsAskedFor) {
  const TempFolder folder;
  Image line(31, 31, 3);
  for (int y = 0; y < 31; ++y) line.setRgb(15, y, vec3(1.0F));
  writePng(folder.file("a.png"), line);
  writePng(folder.file("b.png"), Image(31, 31, 3));
  const auto flipFrom = [&](const char* pixels_per_degree) {
    const ProcessResult result = runNephroid({"compare", folder.file("a.png"), folder.file("b.png"), "--metric", "flip",
                                              "--pixels-per-degree", pixels_per_degree, "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  };
  const nlohmann::json near = flipFrom("30"), far = flipFrom("120");
  EXPECT_EQ(near["flip"]["pixels_per_degree"], 30.0);
  EXPECT_NE(near["metrics"]["flip"], far["metrics"]["flip"]);
  EXPECT_THAT(runNephroid({"compare", folder.file("a.png"), folder.file("b.png")}).out,
              HasSubstr("  LDR, 67 pixels per degree\n"));
  EXPECT_EQ(runNephroid({"compare", "a.png", "b.png", "--pixels-per-degree", "9"}).exit_code, 2);
}

TEST(Compare, WritesAPageWithItsFiguresAndTheFilesMetadata) {
  const TempFolder folder;
  const std::string a = folder.file("a&b.exr"), b = folder.file("b.exr"), page_file = folder.file("page.html");
  writeConstant(a, 4, 3, {{"beauty", 3.0F}});
  LayeredImage reference{.width = 4, .height = 3};
  reference.layers.push_back({"beauty", Image(4, 3, 3, 2.0F)});
  reference.metadata["scene"] = "</td><script>alert(1)</script>";
  writeExr(b, reference);
  const ProcessResult result = runNephroid({"compare", a, b, "--metric", "relmse", "--html", page_file});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("wrote " + page_file));
  const std::string page = readText(page_file);
  EXPECT_THAT(page, HasSubstr("a&amp;b.exr"));
  EXPECT_THAT(page, HasSubstr("layer beauty, 12 pixels; flip: HDR, 67 pixels per degree"));
  EXPECT_THAT(page, HasSubstr("<td>&lt;/td&gt;&lt;script&gt;alert(1)&lt;/script&gt;</td>"));
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  // The same number as in the table.
  const std::size_t begin = result.out.find("relmse");
  ASSERT_NE(begin, std::string::npos);
  std::string value = result.out.substr(begin + 6, result.out.find('\n', begin) - begin - 6);
  value.erase(0, value.find_first_not_of(' '));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">relmse</th><td>" + value + "</td>"));
}

TEST(Compare, PageThatCannotBeWrittenIsSaidBeforeTheWork) {
  const TempFolder folder;
  const ProcessResult result = runNephroid({"compare", "none.exr", "none.exr", "--html", folder.file("no/page.html")});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(countLines(result.err), 1) << result.err;
}

TEST(Compare, UnknownMetricIsWrongUsage) {
  const TempFolder folder;
  writeConstant(folder.file("a.exr"), 4, 3, {{"beauty", 1.0F}});
  const ProcessResult result =
      runNephroid({"compare", folder.file("a.exr"), folder.file("a.exr"), "--metric", "beauty"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("rmse"));
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

/// One row of grey pixels in `beauty`.
void writeRow(const std::string& path, const std::vector<float>& values) {
  const int width = static_cast<int>(values.size());
  LayeredImage image{.width = width, .height = 1};
  image.layers.push_back({"beauty", Image(width, 1, 3)});
  for (int x = 0; x < width; ++x) image.layers[0].image.setRgb(x, 0, vec3(values[static_cast<std::size_t>(x)]));
  writeExr(path, image);
}

TEST(Compare, LeavesOutAndCountsPixelsThatAreNotFinite) {
  const TempFolder folder;
  writeRow(folder.file("a.exr"), {kNan, 3.0F, kInf, 3.0F});
  writeRow(folder.file("b.exr"), {1.0F, 2.0F, kNan, kNan});
  const ProcessResult result = runNephroid({"compare", folder.file("a.exr"), folder.file("b.exr"), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["pixels"], 1);
  EXPECT_EQ(json["not_finite"]["image"], 2);
  EXPECT_EQ(json["not_finite"]["reference"], 2);
  EXPECT_NEAR(json["metrics"]["rmse"].get<double>(), 1.0, 1e-6);
  EXPECT_DOUBLE_EQ(json["ratio"][2].get<double>(), 1.5);
  EXPECT_THAT(result.err, HasSubstr("warning: " + folder.file("a.exr") + ": pixels that are NaN or infinite"));
  EXPECT_THAT(result.err, HasSubstr("warning: " + folder.file("b.exr")));
  const ProcessResult text = runNephroid({"compare", folder.file("a.exr"), folder.file("b.exr")});
  EXPECT_THAT(text.out, HasSubstr("1 pixels, left out as not finite: 2 of the image, 2 of the reference"));
  EXPECT_THAT(text.out, Not(HasSubstr("nan")));
}

TEST(Compare, SaysNothingOfPixelsThatAreNotFiniteWhereThereAreNone) {
  const TempFolder folder;
  writeRow(folder.file("a.exr"), {kNan, 3.0F});
  writeRow(folder.file("b.exr"), {1.0F, 2.0F});
  Image mask(2, 1, 3, 1.0F);
  mask.setRgb(0, 0, vec3(0.0F));
  writePng(folder.file("m.png"), mask);
  const ProcessResult result =
      runNephroid({"compare", folder.file("a.exr"), folder.file("b.exr"), "--mask", folder.file("m.png")});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, Not(HasSubstr("finite")));
}

/// Exit code 3, nothing on stdout, one line "error: …" on stderr that holds `text`.
void expectBadInput(const std::vector<std::string>& arguments, const std::string& text) {
  const ProcessResult result = runNephroid(arguments);
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, StartsWith("error: "));
  EXPECT_THAT(result.err, HasSubstr(text));
  EXPECT_EQ(countLines(result.err), 1) << result.err;
}

TEST(Compare, PicturesWithoutOneFinitePixelInCommonAreBadInput) {
  const TempFolder folder;
  writeRow(folder.file("a.exr"), {kNan, 3.0F});
  writeRow(folder.file("b.exr"), {1.0F, kInf});
  expectBadInput({"compare", folder.file("a.exr"), folder.file("b.exr")}, "none is finite in both");
  expectBadInput({"compare", folder.file("a.exr"), folder.file("b.exr"), "--json"}, "none is finite in both");
}

TEST(Compare, MasksThatSelectNothingOrDoNotFitAreBadInput) {
  const TempFolder folder;
  writeRow(folder.file("a.exr"), {1.0F, 2.0F});
  const auto compareWithMask = [&](const char* mask) {
    return std::vector<std::string>{"compare", folder.file("a.exr"), folder.file("a.exr"), "--mask", folder.file(mask)};
  };
  writePng(folder.file("grey.png"), Image(2, 1, 3, 0.5F));
  expectBadInput(compareWithMask("grey.png"), "no pixel has the value 255");
  writePng(folder.file("wide.png"), Image(3, 1, 3, 1.0F));
  expectBadInput(compareWithMask("wide.png"), "3x1 px");
  expectBadInput(compareWithMask("a.exr"), "8-bit PNG");
  expectBadInput(compareWithMask("none.png"), "none.png");
}

TEST(Compare, PicturesWithoutACommonLayerAreBadInput) {
  const TempFolder folder;
  writeConstant(folder.file("a.exr"), 2, 2, {{"direct", 1.0F}});
  writeConstant(folder.file("b.exr"), 2, 2, {{"caustic", 1.0F}});
  const std::string a = folder.file("a.exr"), b = folder.file("b.exr");
  expectBadInput({"compare", a, b}, "no layer in common");
  expectBadInput({"compare", a, b, "--layer", "direct"}, b + ": layer 'direct' is not in the image");
  expectBadInput({"compare", a, b, "--layer", "direct+indirect"}, a + ": layer 'indirect' is not in the image");
  expectBadInput({"compare", a, a, "--layer", "direct+"}, "layer ''");
}

// A ratio to black is infinite, or none at all if both are black: JSON has no word for either.
TEST(Compare, JsonIsValidWhereFiguresAreNotFinite) {
  const TempFolder folder;
  writeRow(folder.file("a.exr"), {1.0F, 0.0F});
  writeRow(folder.file("b\xff.exr"), {0.0F, 0.0F});
  const ProcessResult result = runNephroid({"compare", folder.file("a.exr"), folder.file("b\xff.exr"), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_TRUE(json["ratio"][0].is_null());
  EXPECT_TRUE(json["metrics"]["nrmse"].is_null());
  EXPECT_EQ(json["mean"][0], 0.5);
  EXPECT_THAT(json["reference"].get<std::string>(), HasSubstr("b"));
}

TEST(Compare, PageShowsWhatPngFilesSayOfThemselves) {
  const TempFolder folder;
  const auto draw = [&](const char* file, const char* seed) {
    return runNephroid({"render", "builtin:ring", "-o", folder.file(file), "--size", "16x12", "--samples", "1",
                        "--photons", "500", "--seed", seed})
        .exit_code;
  };
  ASSERT_EQ(draw("a.png", "41"), 0);
  ASSERT_EQ(draw("b.png", "43"), 0);
  const ProcessResult result =
      runNephroid({"compare", folder.file("a.png"), folder.file("b.png"), "--html", folder.file("page.html")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string page = readText(folder.file("page.html"));
  for (const char* text : {"builtin:ring", ">41<", ">43<"}) EXPECT_THAT(page, HasSubstr(text));
}

}  // namespace
}  // namespace nephroid::test
