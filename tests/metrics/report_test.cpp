// The page of a comparison: what stands in it, and that nothing from files can change it.
#include "metrics/report.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <span>

#include "core/image/image_io.h"
#include "metrics/html.h"
#include "metrics/report_histogram.h"
#include "metrics/report_pictures.h"
#include "nephroid/error.h"

namespace nephroid {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(EscapeHtml, LeavesNothingThatMeansAnything) {
  EXPECT_EQ(escapeHtml("a<b>&\"c'"), "a&lt;b&gt;&amp;&quot;c&#39;");
  EXPECT_EQ(escapeHtml("\xc3\xa4 \xff \x01"), "\xc3\xa4 \xef\xbf\xbd \xef\xbf\xbd");
  EXPECT_EQ(escapeHtml(std::string_view("a\0b\n", 4)),
            "a\xef\xbf\xbd"
            "b\n");
}

// The test vectors of RFC 4648, section 10.
TEST(MakePngUri, IsBase64) {
  const auto encode = [](std::string_view text) {
    return makePngUri(std::as_bytes(std::span(text))).substr(std::string_view("data:image/png;base64,").size());
  };
  EXPECT_EQ(encode(""), "");
  EXPECT_EQ(encode("f"), "Zg==");
  EXPECT_EQ(encode("fo"), "Zm8=");
  EXPECT_EQ(encode("foo"), "Zm9v");
  EXPECT_EQ(encode("foobar"), "Zm9vYmFy");
}

TEST(FillTemplate, ReplacesNamesOnce) {
  EXPECT_EQ(fillTemplate("a {{x}} {{y}} {{x}}", {{"x", "{{y}}"}, {"y", "2"}}), "a {{y}} 2 {{y}}");
  EXPECT_THROW(fillTemplate("{{z}}", {}), InternalError);
  EXPECT_THROW(fillTemplate("{{x", {{"x", ""}}), InternalError);
}

/// What the page's program makes of the bytes.
float unpack(const PackedPicture& packed, int x, int y, int c) {
  const auto byte = [&](int row) { return static_cast<unsigned>(std::lround(255.0F * packed.bytes.at(x, row)[c])); };
  const auto half = static_cast<std::uint16_t>(byte(y) << 8 | byte(packed.bytes.height / 2 + y));
  return std::ldexp(glm::unpackHalf1x16(half), packed.exponent);
}

TEST(PackPicture, KeepsValuesToThreeDigits) {
  for (const float unit : {1e-12F, 1.0F, 1e12F}) {
    Image picture(2, 2, 3);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
      picture.pixels[i] = unit * std::ldexp(1.37F, -static_cast<int>(i)) * (i % 3 == 1 ? -1.0F : 1.0F);
    const PackedPicture packed = packPicture(picture);
    EXPECT_EQ(packed.bytes.height, 4);
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 2; ++x)
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(unpack(packed, x, y, c), picture.at(x, y)[c], 5e-4F * std::abs(picture.at(x, y)[c]));
  }
}

TEST(PackPicture, KeepsWhatIsNotFinite) {
  Image picture(1, 1, 3);
  picture.setRgb(0, 0, {std::numeric_limits<float>::quiet_NaN(), kInfinity, 0.0F});
  const PackedPicture packed = packPicture(picture);
  EXPECT_TRUE(std::isnan(unpack(packed, 0, 0, 0)));
  EXPECT_EQ(unpack(packed, 0, 0, 1), kInfinity);
  EXPECT_EQ(unpack(packed, 0, 0, 2), 0.0F);
}

TEST(ColourScale, RunsFromEndToEnd) {
  const ColourScale logarithmic{.logarithmic = true, .lower = 0.01F, .upper = 100.0F};
  const ColourScale linear{};
  EXPECT_LT(length(logarithmic.colour(1.0F) - linear.colour(0.5F)), 1e-5F);
  EXPECT_EQ(logarithmic.colour(0.0F), linear.colour(-1.0F));
  EXPECT_EQ(logarithmic.colour(kInfinity), linear.colour(1.0F));
  for (int i = 1; i <= 10; ++i)
    EXPECT_GT(luminance(linear.colour(0.1F * static_cast<float>(i))),
              luminance(linear.colour(0.1F * static_cast<float>(i - 1))));
  const ColourScale diverging{.diverging = true, .lower = -2.0F, .upper = 2.0F};
  EXPECT_GT(diverging.colour(-2.0F).z, diverging.colour(-2.0F).x);
  EXPECT_GT(diverging.colour(2.0F).x, diverging.colour(2.0F).z);
  EXPECT_EQ(diverging.colour(0.0F).x, diverging.colour(0.0F).z);
}

TEST(ComputeRelMseMap, HasTheMetricAsItsMean) {
  Image image(3, 2, 3), reference(3, 2, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = static_cast<float>(i % 5), reference.pixels[i] = static_cast<float>(1 + i % 4);
  for (const std::vector<std::uint8_t>& mask : {std::vector<std::uint8_t>{}, {255, 0, 0, 0, 255, 0}}) {
    const Image map = computeRelMseMap(image, reference, mask);
    EXPECT_NEAR(maskedMean(map, mask).x, findMetric("relmse").compute(image, reference, mask, {}), 1e-6);
  }
}

Image makePicture(float offset) {
  Image image(4, 3, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = offset + 0.1F * static_cast<float>(i);
  return image;
}

const Image kImage = makePicture(0.5F), kReference = makePicture(0.4F);

ReportContent makeContent() {
  ReportContent content{.image = {"a.exr", kImage, {{"samples", "16"}, {"seed", "1"}}},
                        .reference = {"b.exr", kReference, {{"samples", "64"}, {"seed", "1"}, {"version", "2"}}}};
  content.summary = "layer caustic, 12 pixels";
  content.image_mean = maskedMean(kImage, {});
  content.reference_mean = maskedMean(kReference, {});
  for (const Metric& metric : metrics())
    content.figures.emplace_back(metric.name, metric.compute(kImage, kReference, {}, {}));
  return content;
}

/// Opens and closes tags as a browser would if they are well nested. @return what is wrong, or ""
std::string findBadNesting(const std::string& page) {
  const std::set<std::string> no_content{"meta", "img", "input"};
  const std::regex tag(R"(<(/?)([a-zA-Z0-9]+)((?:\s+[a-zA-Z-]+(?:="[^"<]*")?)*)\s*(/?)>)");
  std::vector<std::string> open;
  std::size_t at = page.find("<html");
  while ((at = page.find('<', at)) != std::string::npos) {
    std::smatch match;
    // Up to its end only: pictures are long.
    const std::string text = page.substr(at, page.find('>', at) + 1 - at);
    const std::string brief = std::regex_replace(text, std::regex("base64,[A-Za-z0-9+/=]*"), "base64,");
    if (!std::regex_match(brief, match, tag)) return "no tag: " + brief.substr(0, 80);
    at += text.size();
    const std::string name = match[2];
    if (match[1] == "/") {
      if (open.empty() || open.back() != name) return "closes " + name;
      open.pop_back();
    } else if (match[4] != "/" && !no_content.contains(name)) {
      open.push_back(name);
    } else if (match[4] != "/") {
      return "not closed: " + name;
    }
    if (match[1] != "/" && (name == "script" || name == "style")) at = page.find("</" + name, at);
  }
  return open.empty() ? "" : "open: " + open.back();
}

TEST(Report, IsWellFormedAndNeedsNoNetwork) {
  const std::string page = makeReport(makeContent());
  EXPECT_EQ(findBadNesting(page), "");
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  for (const char* outside : {"http:", "https:", "//cdn", "@import", "url("})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
}

std::vector<std::byte> decodeBase64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::byte> bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> count & 0xffU));
  }
  return bytes;
}

/// The picture of the element with that id, as bytes over 255.
Image readPicture(const std::string& page, const std::string& id) {
  const std::size_t element = page.find("id=\"" + id + "\"");
  const std::string_view head = "src=\"data:image/png;base64,";
  const std::size_t begin = page.find(head, element) + head.size();
  return toLinear(decodeImage(decodeBase64(page.substr(begin, page.find('"', begin) - begin)), id), false);
}

nlohmann::json readSettings(const std::string& page) {
  const std::string head = "<script type=\"application/json\" id=\"settings\">";
  const std::size_t begin = page.find(head) + head.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

TEST(Report, HoldsBothPicturesAsTheyAre) {
  const std::string page = makeReport(makeContent());
  const nlohmann::json settings = readSettings(page);
  EXPECT_EQ(settings["width"], 4);
  EXPECT_EQ(settings["height"], 3);
  for (const auto& [name, picture] : {std::pair{"image", &kImage}, std::pair{"reference", &kReference}}) {
    const PackedPicture packed{readPicture(page, std::string(name) + "-bytes"),
                               settings[std::string(name) + "Exponent"].get<int>()};
    ASSERT_EQ(packed.bytes.width, 4);
    ASSERT_EQ(packed.bytes.height, 6);
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 4; ++x)
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(unpack(packed, x, y, c), picture->at(x, y)[c], 5e-4F * picture->at(x, y)[c]) << name;
  }
}

TEST(Report, HasTheMapOfFlipInTheColoursOfItsScale) {
  const Image drawn = readPicture(makeReport(makeContent()), "flip");
  const Image map = computeFlipMap(kImage, kReference, {});
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x) EXPECT_LT(length(drawn.rgb(x, y) - ColourScale{}.colour(*map.at(x, y))), 0.005F);
}

TEST(Report, DifferenceIsRedWhereTheImageIsTooBright) {
  const Image drawn = readPicture(makeReport(makeContent()), "difference");
  EXPECT_GT(drawn.rgb(1, 1).x, drawn.rgb(1, 1).z + 0.3F);
}

TEST(Report, HasTheFiguresAndBothFilesMetadata) {
  const ReportContent content = makeContent();
  const std::string page = makeReport(content);
  for (const auto& [name, value] : content.figures)
    EXPECT_THAT(page, HasSubstr(fmt::format("<th scope=\"row\">{}</th><td>{:.6g}</td>", name, value)));
  EXPECT_THAT(page, HasSubstr("<p>layer caustic, 12 pixels</p>"));
  EXPECT_THAT(page, HasSubstr("<tr class=\"differs\"><th scope=\"row\">samples</th><td>16</td><td>64</td></tr>"));
  EXPECT_THAT(page, HasSubstr("<tr><th scope=\"row\">seed</th><td>1</td><td>1</td></tr>"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">version</th><td>\xe2\x80\x93</td><td>2</td>"));
}

TEST(Report, EscapesWhateverNamesAndMetadataHold) {
  const std::string hostile = "\"'></td></script><script>alert(1)</script><img src=x onerror=alert(1)>{{script}}\xff";
  ReportContent content{.image = {hostile, kImage, {{hostile, hostile}}},
                        .reference = {hostile, kReference, {{"scene", hostile}}}};
  content.summary = hostile;
  const std::string page = makeReport(content);
  EXPECT_EQ(findBadNesting(page), "");
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, Not(HasSubstr("<img src=x")));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(1)&lt;/script&gt;"));
  const auto countScripts = [](const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find("<script", at)) != std::string::npos; ++at) ++count;
    return count;
  };
  EXPECT_EQ(countScripts(page), 2U);
}

TEST(Report, OfBlackAndUnknownPixelsIsStillAPage) {
  const Image black(2, 2, 3);
  Image bad = black;
  bad.setRgb(0, 0, vec3(std::numeric_limits<float>::quiet_NaN()));
  const std::vector<std::uint8_t> mask{0, 255, 255, 255};
  const ReportContent content{.image = {"a", bad, {}}, .reference = {"b", black, {}}, .mask = mask};
  const std::string page = makeReport(content);
  EXPECT_EQ(findBadNesting(page), "");
  EXPECT_THAT(page, HasSubstr("None. It is read from EXR files."));
  EXPECT_NO_THROW(readSettings(page));
}

TEST(DrawHistogram, CountsPixelsByLuminance) {
  Image image(4, 1, 1);
  image.pixels = {1.0F, 1.0F, 0.0F, 1e-9F};
  const std::string svg = drawHistogram(image, Image(4, 1, 1, 0.5F));
  EXPECT_EQ(findBadNesting("<html>" + svg + "</html>"), "");
  EXPECT_THAT(svg, HasSubstr("Darker: 50 % of the image, 0 % of the reference."));
  // Half of the image's pixels are in the last step; all of the reference's, the highest step, a stop before.
  EXPECT_THAT(svg, HasSubstr("L630.0 100.0H640.0\"/>"));
  EXPECT_THAT(svg, HasSubstr("L590.0 200.0H600.0L600.0 0.0H610.0"));
}

}  // namespace
}  // namespace nephroid
