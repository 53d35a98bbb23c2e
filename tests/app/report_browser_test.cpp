// The page of `compare --html` in a browser, from a file:// address, used as people use it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "app/browser.h"
#include "app/process.h"
#include "core/image/image_io.h"

namespace nephroid::test {
namespace {

using ::testing::HasSubstr;

constexpr int kWidth = 32, kHeight = 24;

/// A picture of one colour but for one pixel in white.
void writeFlat(const std::string& path, vec3 colour) {
  Image image(kWidth, kHeight, 3);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) image.setRgb(x, y, colour);
  image.setRgb(20, 10, vec3(1.0F));
  writeExr(path, {.width = kWidth, .height = kHeight, .layers = {{"beauty", image}}});
}

struct Point {
  double x = 0, y = 0;
};

class ReportInBrowser : public testing::Test {
 protected:
  ReportInBrowser() : browser_(NEPHROID_CHROMIUM, profile_.path().string()) {}

  void SetUp() override {
    writeFlat(folder_.file("red.exr"), vec3(0.5F, 0.0F, 0.0F));
    writeFlat(folder_.file("green.exr"), vec3(0.0F, 0.5F, 0.0F));
    const ProcessResult result = runNephroid(
        {"compare", folder_.file("red.exr"), folder_.file("green.exr"), "--html", folder_.file("page.html")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    // High enough that nothing has to be scrolled to.
    browser_.open(folder_.file("page.html"), 1200, 2400);
    // The pictures are decoded after the page is loaded.
    browser_.evaluate(
        "new Promise(done => { const wait = () => document.getElementById('exposure-value').textContent"
        ".includes('EV') ? done() : setTimeout(wait, 20); wait(); })");
  }

  double number(const std::string& expression) { return browser_.evaluate(expression).get<double>(); }
  std::string text(const std::string& id) {
    return browser_.evaluate("document.getElementById('" + id + "').textContent").get<std::string>();
  }
  /// A place in an element, as shares of its width and height.
  Point placeIn(const std::string& selector, double across = 0.5, double down = 0.5) {
    const std::string box = "document.querySelector('" + selector + "').getBoundingClientRect()";
    return {number(box + ".left") + across * number(box + ".width"),
            number(box + ".top") + down * number(box + ".height")};
  }
  void drag(Point from, Point to) {
    browser_.movePointer(from.x, from.y);
    browser_.press(from.x, from.y);
    browser_.movePointer(0.5 * (from.x + to.x), 0.5 * (from.y + to.y), true);
    browser_.movePointer(to.x, to.y, true);
    browser_.release(to.x, to.y);
  }
  void click(const std::string& selector) {
    const Point at = placeIn(selector);
    browser_.movePointer(at.x, at.y);
    browser_.press(at.x, at.y);
    browser_.release(at.x, at.y);
  }
  /// How much larger than fitting the picture of each view is, and which place of it is in the view's middle: views
  /// have different shapes, so that nothing else is the same of those that move together.
  std::vector<std::string> transforms() {
    return browser_
        .evaluate(
            "[...document.querySelectorAll('.view')].map(view => { const box = view.getBoundingClientRect();"
            "const p = view.querySelector('.picture').getBoundingClientRect();"
            "const fit = Math.min(view.clientWidth / p.width, view.clientHeight / p.height);"
            "return [1 / fit, (box.left + box.width / 2 - p.left) / p.width,"
            "(box.top + box.height / 2 - p.top) / p.height].map(v => v.toFixed(2)).join(' '); })")
        .get<std::vector<std::string>>();
  }
  void expectAllAlike() {
    const std::vector<std::string> all = transforms();
    ASSERT_GE(all.size(), 4U);  // the pictures, and three maps
    for (const std::string& transform : all) EXPECT_EQ(transform, all.front());
  }
  /// Colour on the screen.
  vec3 colourAt(const Image& screen, Point at) { return screen.rgb(static_cast<int>(at.x), static_cast<int>(at.y)); }
  Image screenshot() {
    const std::string png = browser_.takeScreenshot();
    return toLinear(decodeImage(std::as_bytes(std::span(png)), "screenshot"));
  }

  TempFolder folder_, profile_;
  Browser browser_;
};

TEST_F(ReportInBrowser, DividerIsDraggedAndShowsTheImageOnItsLeft) {
  drag(placeIn("#handle"), placeIn("#pictures", 0.25));
  EXPECT_NEAR(number("Number(document.getElementById('divider').value)"), 25.0, 1.0);
  const Image screen = screenshot();
  const vec3 left = colourAt(screen, placeIn("#pictures", 0.2, 0.7)),
             right = colourAt(screen, placeIn("#pictures", 0.3, 0.7));
  EXPECT_GT(left.x, 0.2F);
  EXPECT_LT(left.y, 0.05F);
  EXPECT_GT(right.y, 0.2F);
  EXPECT_LT(right.x, 0.05F);
}

TEST_F(ReportInBrowser, PicturesAndMapsAreZoomedAndMovedTogether) {
  const std::vector<std::string> fitting = transforms();
  expectAllAlike();
  const Point on_map = placeIn(".maps .view", 0.4, 0.4);
  browser_.movePointer(on_map.x, on_map.y);
  browser_.turnWheel(on_map.x, on_map.y, -500);
  // Input of a wheel is handed on with the next frame.
  browser_.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))");
  const std::vector<std::string> zoomed = transforms();
  EXPECT_NE(zoomed, fitting);
  expectAllAlike();
  drag(placeIn(".maps .view", 0.4), placeIn(".maps .view", 0.6));
  EXPECT_NE(transforms(), zoomed);
  expectAllAlike();
  click("#fit");
  EXPECT_EQ(transforms(), fitting);
  click("#zoom-in");
  EXPECT_NE(transforms(), fitting);
  click("#pictures");
  browser_.type("0");
  EXPECT_EQ(transforms(), fitting);
}

TEST_F(ReportInBrowser, PixelUnderThePointerIsRead) {
  // The picture fits its view one way or the other: ask for the middle of pixel 20, 10 where it is drawn.
  const Point at = placeIn("#image-canvas", 20.5 / kWidth, 10.5 / kHeight);
  browser_.movePointer(at.x, at.y);
  EXPECT_THAT(text("pixel"), HasSubstr("pixel 20, 10: image 1.000  1.000  1.000; reference 1.000  1.000  1.000"));
  const Point beside = placeIn("#image-canvas", 3.5 / kWidth, 10.5 / kHeight);
  browser_.movePointer(beside.x, beside.y);
  EXPECT_THAT(text("pixel"), HasSubstr("pixel 3, 10: image 0.5000  0.000  0.000; reference 0.000  0.5000  0.000"));
}

TEST_F(ReportInBrowser, ExposureBrightensBoth) {
  const Point place = placeIn("#pictures", 0.2, 0.7);
  const float before = colourAt(screenshot(), place).x;
  browser_.evaluate(
      "(() => { const e = document.getElementById('exposure'); e.value = Number(e.value) - 2;"
      "e.dispatchEvent(new Event('input')); })()");
  EXPECT_NEAR(colourAt(screenshot(), place).x / before, 0.25, 0.02);
}

}  // namespace
}  // namespace nephroid::test
