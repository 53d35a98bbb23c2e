#include "scene/import/accessor_reader.h"

#include <gtest/gtest.h>

#include "nephroid/error.h"
#include "support/gltf_builder.h"

namespace nephroid::gltf {
namespace {

using testing_support::GltfBuilder;
using testing_support::json;

/// Loads the builder's file and reads accessor 0 as vec3.
std::vector<vec3> readFirst(GltfBuilder& builder) {
  Document document = loadDocument(builder.write());
  return AccessorReader(document).readVec3(0, "test");
}

TEST(AccessorReader, ReadsFloats) {
  GltfBuilder builder;
  builder.addVec3({{1, 2, 3}, {4, 5, 6}});
  EXPECT_EQ(readFirst(builder), (std::vector<vec3>{{1, 2, 3}, {4, 5, 6}}));
}

TEST(AccessorReader, FollowsOffsetAndStride) {
  GltfBuilder builder;
  builder.addAccessor(std::vector<float>{9, 1, 2, 3, 9, 4, 5, 6}, testing_support::kFloat, "VEC3", 2);
  builder.root["accessors"][0]["byteOffset"] = 4;
  builder.root["bufferViews"][0]["byteStride"] = 16;
  EXPECT_EQ(readFirst(builder), (std::vector<vec3>{{1, 2, 3}, {4, 5, 6}}));
}

TEST(AccessorReader, NormalisesIntegersByTheirRange) {
  GltfBuilder builder;
  builder.addAccessor(std::vector<std::int8_t>{127, -127, -128}, testing_support::kByte, "VEC3", 1);
  builder.root["accessors"][0]["normalized"] = true;
  EXPECT_EQ(readFirst(builder), (std::vector<vec3>{{1, -1, -1}}));
  builder.root["accessors"][0]["normalized"] = false;
  EXPECT_EQ(readFirst(builder), (std::vector<vec3>{{127, -127, -128}}));
}

TEST(AccessorReader, ReadsUnsignedShortsAsTheyAre) {
  GltfBuilder builder;
  builder.addAccessor(std::vector<std::uint16_t>{0, 65535, 7}, testing_support::kUShort, "VEC3", 1);
  EXPECT_EQ(readFirst(builder), (std::vector<vec3>{{0, 65535, 7}}));
}

TEST(AccessorReader, SubstitutesSparseValues) {
  GltfBuilder builder;
  builder.addVec3({{1, 1, 1}, {2, 2, 2}, {3, 3, 3}});
  const int indices = builder.addView(std::vector<std::uint16_t>{1});
  const int values = builder.addView(std::vector<float>{7, 8, 9});
  builder.root["accessors"][0]["sparse"] = {{"count", 1},
                                            {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                            {"values", {{"bufferView", values}}}};
  EXPECT_EQ(readFirst(builder), (std::vector<vec3>{{1, 1, 1}, {7, 8, 9}, {3, 3, 3}}));
  builder.root["accessors"][0].erase("bufferView");
  EXPECT_EQ(readFirst(builder), (std::vector<vec3>{{0, 0, 0}, {7, 8, 9}, {0, 0, 0}}));
}

TEST(AccessorReader, RefusesSparseIndicesBeyondTheCount) {
  GltfBuilder builder;
  builder.addVec3({{1, 1, 1}, {2, 2, 2}});
  const int indices = builder.addView(std::vector<std::uint16_t>{2});
  const int values = builder.addView(std::vector<float>{7, 8, 9});
  builder.root["accessors"][0]["sparse"] = {{"count", 1},
                                            {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                            {"values", {{"bufferView", values}}}};
  EXPECT_THROW(readFirst(builder), InputError);
  builder.root["accessors"][0]["sparse"]["count"] = 1000000;
  EXPECT_THROW(readFirst(builder), InputError);
}

TEST(AccessorReader, ReadsZerosWithoutABufferView) {
  GltfBuilder builder;
  builder.root["accessors"] = {{{"componentType", 5126}, {"type", "VEC3"}, {"count", 2}}};
  EXPECT_EQ(readFirst(builder), (std::vector<vec3>{vec3(0), vec3(0)}));
}

/// A change to a sound accessor that must be refused before anything is read or allocated.
struct Spoiled {
  const char* name;
  const char* pointer;
  json value;
};
void PrintTo(const Spoiled& spoiled, std::ostream* out) { *out << spoiled.name; }

class HostileAccessor : public testing::TestWithParam<Spoiled> {};

TEST_P(HostileAccessor, IsRefused) {
  GltfBuilder builder;
  builder.addVec3({{1, 2, 3}, {4, 5, 6}});
  EXPECT_NO_THROW(readFirst(builder));
  builder.root[json::json_pointer(GetParam().pointer)] = GetParam().value;
  EXPECT_THROW(readFirst(builder), InputError);
}

INSTANTIATE_TEST_SUITE_P(
    Fields, HostileAccessor,
    testing::Values(Spoiled{"CountAboveTheView", "/accessors/0/count", 3},
                    Spoiled{"CountHuge", "/accessors/0/count", 1ULL << 40},
                    Spoiled{"CountTimesSizeOverflows", "/accessors/0/count", 9007199254740992ULL},
                    Spoiled{"CountZero", "/accessors/0/count", 0}, Spoiled{"CountNegative", "/accessors/0/count", -1},
                    Spoiled{"OffsetAboveTheView", "/accessors/0/byteOffset", 4},
                    Spoiled{"OffsetHuge", "/accessors/0/byteOffset", 9007199254740000ULL},
                    Spoiled{"ViewMissing", "/accessors/0/bufferView", 1},
                    Spoiled{"ViewLongerThanBuffer", "/bufferViews/0/byteLength", 25},
                    Spoiled{"ViewOffsetBeyondBuffer", "/bufferViews/0/byteOffset", 25},
                    Spoiled{"ViewOffsetOverflows", "/bufferViews/0/byteOffset", 9007199254740992ULL},
                    Spoiled{"BufferMissing", "/bufferViews/0/buffer", 7},
                    Spoiled{"StrideBelowElement", "/bufferViews/0/byteStride", 8},
                    Spoiled{"StrideBeyondEnd", "/bufferViews/0/byteStride", 16},
                    Spoiled{"ComponentTypeInt", "/accessors/0/componentType", 5124},
                    Spoiled{"ComponentTypeDouble", "/accessors/0/componentType", 5130},
                    Spoiled{"ComponentTypeNonsense", "/accessors/0/componentType", 1},
                    Spoiled{"TypeWithOtherLength", "/accessors/0/type", "VEC2"},
                    Spoiled{"TypeMatrix", "/accessors/0/type", "MAT2"},
                    Spoiled{"TypeUnknown", "/accessors/0/type", "VEC9"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(AccessorReader, RefusesManyElementsWithoutData) {
  GltfBuilder builder;
  builder.root["accessors"] = {{{"componentType", 5126}, {"type", "VEC3"}, {"count", kMaxElementsWithoutData + 1}}};
  EXPECT_THROW(readFirst(builder), InputError);
}

TEST(AccessorReader, WarnsAboutMisalignedDataAndReadsThem) {
  GltfBuilder builder;
  std::vector<std::uint8_t> bytes(14, 0);
  const float one = 1.0F;
  std::memcpy(&bytes[2], &one, 4);
  builder.addAccessor(bytes, testing_support::kFloat, "VEC3", 1);
  builder.root["accessors"][0]["byteOffset"] = 2;
  Document document = loadDocument(builder.write());
  EXPECT_EQ(AccessorReader(document).readVec3(0, "test"), (std::vector<vec3>{{1, 0, 0}}));
  EXPECT_EQ(document.warnings.take().size(), 1U);
}

TEST(AccessorReader, ReadsIndicesOfEveryUnsignedType) {
  GltfBuilder builder;
  builder.addAccessor(std::vector<std::uint8_t>{1, 255}, testing_support::kUByte, "SCALAR", 2);
  builder.addAccessor(std::vector<std::uint16_t>{1, 65535}, testing_support::kUShort, "SCALAR", 2);
  builder.addAccessor(std::vector<std::uint32_t>{1, 4294967295U}, testing_support::kUInt, "SCALAR", 2);
  builder.addFloats({1, 2});
  Document document = loadDocument(builder.write());
  AccessorReader reader(document);
  EXPECT_EQ(reader.readIndices(0, "test"), (std::vector<std::uint32_t>{1, 255}));
  EXPECT_EQ(reader.readIndices(1, "test"), (std::vector<std::uint32_t>{1, 65535}));
  EXPECT_EQ(reader.readIndices(2, "test"), (std::vector<std::uint32_t>{1, 4294967295U}));
  EXPECT_THROW(reader.readIndices(3, "test"), InputError);
}

}  // namespace
}  // namespace nephroid::gltf
