#include "scene/import/gltf_document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nephroid/error.h"
#include "scene/import/gltf_uri.h"
#include "support/gltf_builder.h"

namespace nephroid::gltf {
namespace {

using testing::HasSubstr;
using testing_support::GltfBuilder;
using testing_support::json;

/// The message with which `use` fails, or "".
template <class Use>
std::string messageOf(const Use& use) {
  try {
    use();
  } catch (const InputError& error) {
    EXPECT_THAT(std::string(error.what()), testing::Not(HasSubstr("\n")));
    return error.what();
  }
  return "";
}

std::string loadMessage(GltfBuilder& builder) {
  return messageOf([&] { builder.load(); });
}

std::string readMessage(GltfBuilder& builder, const std::string& uri) {
  return messageOf([&] { readUri(builder.folder() / "scene.gltf", "buffers[0]", uri, 1000); });
}

TEST(ReadUri, DecodesEscapesAndAllowsSubfolders) {
  GltfBuilder builder;
  builder.writeFile("sub folder/my data.bin", "abc");
  EXPECT_EQ(readUri(builder.folder() / "scene.gltf", "p", "sub%20folder/my%20data.bin", 1000).size(), 3U);
}

TEST(ReadUri, DecodesBase64) {
  GltfBuilder builder;
  const auto bytes = readUri(builder.folder() / "x.gltf", "p", "data:image/webp;base64,AQID", 1000);
  EXPECT_EQ(bytes, (std::vector{std::byte{1}, std::byte{2}, std::byte{3}}));
}

TEST(ReadUri, RefusesToLeaveTheFolder) {
  GltfBuilder builder;
  for (const char* uri : {"../secret", "a/../../secret", "%2e%2e/secret", "/etc/passwd", "%2Fetc/passwd"})
    EXPECT_THAT(readMessage(builder, uri), HasSubstr("URI '" + std::string(uri) + "'"));
}

TEST(ReadUri, RefusesSchemesAndMissingFilesByName) {
  GltfBuilder builder;
  for (const char* uri : {"http://example.com/a.bin", "file:///etc/passwd", "missing.bin", "", "C:\\a.bin"})
    EXPECT_THAT(readMessage(builder, uri), HasSubstr("URI '" + std::string(uri) + "'"));
}

TEST(ReadUri, RefusesMoreBytesThanAllowed) {
  GltfBuilder builder;
  builder.writeFile("big.bin", std::string(1001, 'x'));
  EXPECT_NE(readMessage(builder, "big.bin"), "");
  EXPECT_NE(readMessage(builder, "data:;base64," + std::string(2000, 'A')), "");
}

TEST(LoadDocument, NamesThePlaceAndTypeOfAWrongValue) {
  GltfBuilder builder;
  builder.root["materials"] = {{{"alphaCutoff", "half"}}};
  EXPECT_THAT(loadMessage(builder), HasSubstr("materials[0].alphaCutoff: found string (\"half\"), expected a number"));
  builder.root["materials"] = {{{"emissiveFactor", {1, 2}}}};
  EXPECT_THAT(loadMessage(builder), HasSubstr("materials[0].emissiveFactor: found 2 values, expected 3"));
  builder.root["materials"] = {{{"emissiveFactor", {1, 2, 1e300}}}};
  EXPECT_THAT(loadMessage(builder), HasSubstr("materials[0].emissiveFactor[2]"));
}

TEST(LoadDocument, RefusesDeepJson) {
  GltfBuilder builder;
  const std::string nest(100000, '[');
  const auto path = builder.writeFile("deep.gltf", R"({"asset":{"version":"2.0"},"extras":)" + nest);
  EXPECT_THAT(messageOf([&] { importGltf(path, 0); }), HasSubstr("levels deep"));
}

TEST(LoadDocument, RefusesWhatIsNoGltf) {
  GltfBuilder builder;
  for (const char* text : {"", "{", "[]", "{}", "null", R"({"asset":{"version":"1.0"}})", "glTF", "\xff\xfe"})
    EXPECT_NE(messageOf([&] { importGltf(builder.writeFile("bad.gltf", text), 0); }), "") << text;
  EXPECT_NE(messageOf([&] { importGltf(builder.folder() / "none.gltf", 0); }), "");
}

TEST(LoadDocument, AcceptsWholeNumbersWrittenAsFloats) {
  GltfBuilder builder;
  builder.addNode({{"mesh", builder.addTriangleMesh()}});
  builder.root["nodes"][0]["mesh"] = 0.0;
  EXPECT_EQ(builder.load().triangleCount(), 1U);
}

TEST(LoadDocument, DoesNotLetHostileNamesBreakMessages) {
  GltfBuilder builder;
  builder.root["materials"] = {
      {{"name", "a\nb" + std::string(10000, 'x')}, {"extensions", {{"KHR_materials_ior", {{"ior", 0.5}}}}}}};
  const SceneData scene = builder.load();
  ASSERT_FALSE(scene.warnings.empty());
  for (const std::string& warning : scene.warnings) {
    EXPECT_EQ(warning.find('\n'), std::string::npos);
    EXPECT_LT(warning.size(), 400U);
  }
}

std::string u32(std::uint32_t v) {
  return {static_cast<char>(v & 255U), static_cast<char>(v >> 8U & 255U), static_cast<char>(v >> 16U & 255U),
          static_cast<char>(v >> 24U)};
}

/// A GLB with one triangle whose numbers are in the binary chunk.
std::string makeGlb() {
  std::string text = R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
                     R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[{"byteLength":36}],)"
                     R"("bufferViews":[{"buffer":0,"byteLength":36}],)"
                     R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}]})";
  while (text.size() % 4 != 0) text += ' ';
  const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::string binary(reinterpret_cast<const char*>(positions), sizeof(positions));
  const auto total = static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + binary.size());
  return "glTF" + u32(2) + u32(total) + u32(static_cast<std::uint32_t>(text.size())) + "JSON" + text +
         u32(static_cast<std::uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
}

TEST(LoadDocument, ReadsBinaryFiles) {
  GltfBuilder builder;
  EXPECT_EQ(importGltf(builder.writeFile("a.glb", makeGlb()), 0).triangleCount(), 1U);
}

TEST(LoadDocument, RefusesEveryTruncationOfABinaryFile) {
  GltfBuilder builder;
  const std::string glb = makeGlb();
  for (std::size_t size = 0; size < glb.size(); size += 7)
    EXPECT_THROW(importGltf(builder.writeFile("cut.glb", glb.substr(0, size)), 0), InputError) << size;
}

TEST(Extensions, ThatAreRequiredAndUnknownAreRefusedByName) {
  GltfBuilder builder;
  builder.root["extensionsRequired"] = {"VENDOR_magic"};
  EXPECT_THAT(loadMessage(builder), HasSubstr("VENDOR_magic"));
}

TEST(Extensions, ThatAreUsedAndUnknownAreWarnedAbout) {
  GltfBuilder builder;
  builder.root["extensionsUsed"] = {"KHR_materials_sheen", "KHR_materials_ior"};
  EXPECT_THAT(builder.load().warnings, testing::Contains(HasSubstr("KHR_materials_sheen")));
  EXPECT_THAT(builder.load().warnings, testing::Not(testing::Contains(HasSubstr("KHR_materials_ior"))));
}

}  // namespace
}  // namespace nephroid::gltf
