// Real image files that others made: those that must load, those that must be refused, and those that once broke
// libraries, which must end in a message or in a finite picture.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/image/image_io.h"
#include "nephroid/error.h"

namespace nephroid {
namespace {

namespace fs = std::filesystem;

fs::path getAsset(const std::string& name) { return fs::path(NEPHROID_ASSET_DIR) / "assets" / name; }

/// The files of a folder itself, by name.
std::vector<fs::path> listFiles(const std::string& folder) {
  std::vector<fs::path> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(getAsset(folder)))
    if (entry.is_regular_file()) paths.push_back(entry.path());
  std::ranges::sort(paths);
  return paths;
}

bool isOneLine(const std::string& text) { return text.find('\n') == std::string::npos; }

Image loadFloat(const std::string& name) { return std::get<Image>(loadImage(getAsset(name))); }

bool isFiniteEverywhere(const Image& image) {
  return std::ranges::all_of(image.pixels, [](float v) { return std::isfinite(v); });
}

double computeMean(const Image& image) {
  double sum = 0.0;
  for (const float v : image.pixels) sum += v;
  return sum / static_cast<double>(image.pixels.size());
}

/// Loads a file that may be broken. @return whether there was a picture
bool loadsOrRefuses(const fs::path& path) {
  try {
    const DecodedImage image = loadImage(path);
    if (const Image* linear = std::get_if<Image>(&image)) {
      EXPECT_GT(linear->width * linear->height, 0);
      EXPECT_TRUE(isFiniteEverywhere(*linear));
    } else {
      const ByteImage& bytes = std::get<ByteImage>(image);
      EXPECT_EQ(bytes.pixels.size(), static_cast<std::size_t>(bytes.width) * bytes.height * 4);
    }
    return true;
  } catch (const Error& error) {
    EXPECT_TRUE(error.exitCode() == ExitCode::kBadInput || error.exitCode() == ExitCode::kNoResource);
    EXPECT_TRUE(isOneLine(error.what())) << error.what();
    EXPECT_NE(std::string(error.what()).find(path.filename().string()), std::string::npos) << error.what();
    return false;
  }
}

TEST(ImageAssets, EveryBrokenExrEndsInAMessageOrAFinitePicture) {
  const std::vector<fs::path> paths = listFiles("broken/exr");
  EXPECT_GE(paths.size(), 100U);
  int loaded = 0;
  for (const fs::path& path : paths) {
    SCOPED_TRACE(path.string());
    loaded += loadsOrRefuses(path) ? 1 : 0;
  }
  EXPECT_LT(loaded, static_cast<int>(paths.size()) / 2);
}

TEST(ImageAssets, EveryBrokenExrEndsInAMessageOrLayers) {
  for (const fs::path& path : listFiles("broken/exr")) {
    SCOPED_TRACE(path.string());
    try {
      EXPECT_FALSE(readExr(path).layers.empty());
    } catch (const Error& error) {
      EXPECT_TRUE(error.exitCode() == ExitCode::kBadInput || error.exitCode() == ExitCode::kNoResource);
      EXPECT_TRUE(isOneLine(error.what())) << error.what();
    }
  }
}

TEST(ImageAssets, EveryCorruptPngOfPngSuiteIsRefused) {
  int count = 0;
  for (const fs::path& path : listFiles("broken/png")) {
    SCOPED_TRACE(path.string());
    if (!path.filename().string().starts_with('x')) continue;
    EXPECT_THROW(loadImage(path), InputError);
    ++count;
  }
  EXPECT_GE(count, 7);
}

TEST(ImageAssets, EveryOtherBrokenPngEndsInAMessageOrAPicture) {
  for (const fs::path& path : listFiles("broken/png")) {
    SCOPED_TRACE(path.string());
    loadsOrRefuses(path);
  }
}

TEST(ImageAssets, WrongPngCheckSumIsRefused) {
  EXPECT_THROW(loadImage(getAsset("broken/png/libpng-badadler.png")), InputError);
}

TEST(ImageAssets, EveryUncommonPngLoads) {
  const std::vector<fs::path> paths = listFiles("broken/png/valid");
  EXPECT_GE(paths.size(), 30U);
  for (const fs::path& path : paths) {
    SCOPED_TRACE(path.string());
    const ByteImage image = std::get<ByteImage>(loadImage(path));
    const std::string name = path.filename().string();
    // "s07i3p02": 7 pixels a side.
    const int side = name[0] == 's' ? std::stoi(name.substr(1, 2)) : 32;
    EXPECT_EQ(image.width, side);
    EXPECT_EQ(image.height, side);
  }
}

TEST(ImageAssets, TransparencyOfPngIsRead) {
  const auto has_transparent = [](const std::string& name) {
    const ByteImage image = std::get<ByteImage>(loadImage(getAsset("broken/png/valid/" + name + ".png")));
    for (std::size_t i = 3; i < image.pixels.size(); i += 4)
      if (image.pixels[i] < 255) return true;
    return false;
  };
  // A transparent colour of grey and palette files, an alpha channel, many levels of alpha.
  for (const char* name : {"tbbn0g04", "tbgn3p08", "tp1n3p08", "tm3n3p02", "basi6a08", "basn4a08"})
    EXPECT_TRUE(has_transparent(name)) << name;
  for (const char* name : {"tp0n2c08", "basn3p04", "basi0g01", "basi2c08"}) EXPECT_FALSE(has_transparent(name)) << name;
}

TEST(ImageAssets, DeflateLevelsGiveTheSamePicture) {
  const ByteImage a = std::get<ByteImage>(loadImage(getAsset("broken/png/valid/z03n2c08.png")));
  const ByteImage b = std::get<ByteImage>(loadImage(getAsset("broken/png/valid/z09n2c08.png")));
  EXPECT_EQ(a.pixels, b.pixels);
}

TEST(ImageAssets, NonAsciiFileNameLoads) {
  const Image image = loadFloat("broken/exr/日本語.exr");
  EXPECT_GT(image.width, 0);
  EXPECT_TRUE(isFiniteEverywhere(image));
}

TEST(ImageAssets, EnvironmentsLoad) {
  int count = 0;
  for (const fs::path& path : listFiles("env")) {
    SCOPED_TRACE(path.string());
    const Image image = std::get<Image>(loadImage(path));
    EXPECT_EQ(image.width, 2 * image.height);
    EXPECT_TRUE(isFiniteEverywhere(image));
    EXPECT_GT(computeMean(image), 0.1);
    ++count;
  }
  EXPECT_GE(count, 11);
}

TEST(ImageAssets, BothRunLengthCodingsOfHdrAreRead) {
  EXPECT_GT(computeMean(loadFloat("env/hdr-variants/image1.hdr")), 0.1);
  // A triangle: row y begins with y orange pixels, the rest is blue.
  const Image old = loadFloat("env/hdr-variants/old-rle.hdr");
  ASSERT_EQ(old.width, 551);
  ASSERT_EQ(old.height, 276);
  for (int y = 0; y < old.height; ++y)
    for (int x = 0; x < old.width; ++x)
      ASSERT_EQ(old.rgb(x, y), x < y ? vec3(0.375F, 0.25F, 0.125F) : vec3(0.125F, 0.25F, 0.375F)) << x << ' ' << y;
}

TEST(ImageAssets, DeepExrIsRefusedByName) {
  for (const auto read : {+[](const fs::path& path) { static_cast<void>(loadImage(path)); },
                          +[](const fs::path& path) { static_cast<void>(readExr(path)); }}) {
    try {
      read(getAsset("env/exr-variants/11.deep.exr"));
      FAIL();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("deep OpenEXR images are not supported"), std::string::npos);
    }
  }
}

TEST(ImageAssets, NaNAndInfinityOfExrBecomeFinite) {
  const Image image = loadFloat("env/exr-variants/BrightRingsNanInf.exr");
  EXPECT_TRUE(isFiniteEverywhere(image));
  EXPECT_EQ(std::ranges::max(image.pixels), 65504.0F);
  // Whoever measures sees them.
  EXPECT_FALSE(isFiniteEverywhere(readExr(getAsset("env/exr-variants/BrightRingsNanInf.exr")).layers[0].image));
}

TEST(ImageAssets, LevelZeroOfMipMappedExrIsRead) {
  const Image levels = loadFloat("env/exr-variants/ColorCodedLevels.exr");
  EXPECT_EQ(levels.width, 512);
  EXPECT_EQ(levels.height, 512);
  const Image environment = loadFloat("env/exr-variants/KernerEnvLatLong.exr");
  EXPECT_EQ(environment.width, 1024);
  EXPECT_EQ(environment.height, 512);
}

TEST(ImageAssets, GreyTiledExrIsRead) {
  const Image garden = loadFloat("env/exr-variants/Garden.exr");
  EXPECT_EQ(garden.width, 874);
  EXPECT_EQ(garden.height, 493);
  EXPECT_EQ(garden.rgb(100, 100).x, garden.rgb(100, 100).z);
}

TEST(ImageAssets, CompressionsOfTheSameExrAgree) {
  // ZIP loses nothing; DWAA is made to lose little. The DWAA file repeats the picture of the ZIP file.
  const Image zip = loadFloat("env/exr-variants/comp_zip.exr"), dwaa = loadFloat("env/exr-variants/comp_dwaa_v2.exr");
  ASSERT_EQ(zip.pixels.size(), dwaa.pixels.size());
  EXPECT_NEAR(computeMean(dwaa) / computeMean(zip), 1.0, 1e-3);
  EXPECT_GT(computeMean(loadFloat("env/exr-variants/comp_b44.exr")), 0.0);
}

TEST(ImageAssets, DataWindowIsReadWhateverTheDisplayWindow) {
  EXPECT_EQ(loadFloat("env/exr-variants/t01.exr").pixels, loadFloat("env/exr-variants/t08.exr").pixels);
}

TEST(ImageAssets, ExrWithoutColourNamesItsChannels) {
  try {
    loadFloat("env/exr-variants/v1.7.test.tiled.exr");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("found channels G, Z; expected R, G, B or Y"), std::string::npos);
  }
  EXPECT_NE(readExr(getAsset("env/exr-variants/v1.7.test.tiled.exr")).find("Z"), nullptr);
}

}  // namespace
}  // namespace nephroid
