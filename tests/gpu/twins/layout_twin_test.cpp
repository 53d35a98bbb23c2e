#include "layout_twin.shared.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "shaders/tests/gpu/twins/layout.comp.h"
#include "support/gpu_fixture.h"
#include "support/twin.h"

namespace nephroid::testing {
namespace {

class LayoutTwin : public GpuTest {};

/// Checks that the words of an element count up from its first, field by field, wherever the fields are.
class WordReader {
 public:
  WordReader(const std::byte* bytes, std::uint32_t expected) : bytes_(bytes), expected_(expected) {}

  void expectNext(const char* field, std::size_t offset, float /*of what type the field is*/) {
    float value = 0;
    std::memcpy(&value, bytes_ + offset, sizeof(value));
    EXPECT_EQ(value, static_cast<float>(expected_++)) << field << " at byte " << offset;
  }
  void expectNext(const char* field, std::size_t offset, std::uint32_t /*of what type the field is*/) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes_ + offset, sizeof(value));
    EXPECT_EQ(value, expected_++) << field << " at byte " << offset;
  }
  void expectNext(const char* field, std::size_t offset, const vec3& v) {
    for (int i = 0; i < 3; ++i) expectNext(field, offset + sizeof(float) * static_cast<std::size_t>(i), v[i]);
  }

 private:
  const std::byte* bytes_;
  std::uint32_t expected_;
};

// A field by its place in C++: offsetof, not the order above, says where its bytes must be.
#define NEPHROID_EXPECT_FIELD(reader, base, Struct, field) \
  (reader).expectNext(#Struct "::" #field, (base) + offsetof(Struct, field), Struct{}.field)

TEST_F(LayoutTwin, FieldsAreWhereTheDeviceWritesThem) {
  // Two elements, so that the size of the whole counts.
  const std::vector<LayoutInput> inputs{{100.0F}, {1000.0F}};
  const auto outputs = runOnDevice<LayoutOutput>(device(), shaders::layout_comp, inputs);
  ASSERT_EQ(outputs.size(), inputs.size());
  EXPECT_EQ(sizeof(LayoutOutput), 56 * sizeof(float));
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    SCOPED_TRACE(i);
    const auto* bytes = reinterpret_cast<const std::byte*>(outputs.data() + i);
    WordReader reader(bytes, static_cast<std::uint32_t>(inputs[i].first));
    std::size_t base = offsetof(LayoutOutput, photon);
    NEPHROID_EXPECT_FIELD(reader, base, Photon, position);
    NEPHROID_EXPECT_FIELD(reader, base, Photon, path_length);
    NEPHROID_EXPECT_FIELD(reader, base, Photon, direction);
    NEPHROID_EXPECT_FIELD(reader, base, Photon, light_band_flags);
    NEPHROID_EXPECT_FIELD(reader, base, Photon, flux);
    NEPHROID_EXPECT_FIELD(reader, base, Photon, index);
    NEPHROID_EXPECT_FIELD(reader, base, Photon, chain);
    NEPHROID_EXPECT_FIELD(reader, base, Photon, footprint_major);
    NEPHROID_EXPECT_FIELD(reader, base, Photon, footprint_minor);
    NEPHROID_EXPECT_FIELD(reader, base, Photon, footprint_orientation);
    base = offsetof(LayoutOutput, batch);
    NEPHROID_EXPECT_FIELD(reader, base, PhotonBatch, light);
    NEPHROID_EXPECT_FIELD(reader, base, PhotonBatch, emitted_count);
    NEPHROID_EXPECT_FIELD(reader, base, PhotonBatch, batch);
    NEPHROID_EXPECT_FIELD(reader, base, PhotonBatch, grid_width);
    NEPHROID_EXPECT_FIELD(reader, base, PhotonBatch, grid_height);
    NEPHROID_EXPECT_FIELD(reader, base, PhotonBatch, band_count);
    base = offsetof(LayoutOutput, footprint);
    NEPHROID_EXPECT_FIELD(reader, base, Footprint, axis_a);
    NEPHROID_EXPECT_FIELD(reader, base, Footprint, axis_b);
    base = offsetof(LayoutOutput, normal);
    NEPHROID_EXPECT_FIELD(reader, base, NormalDifferential, dn_dx);
    NEPHROID_EXPECT_FIELD(reader, base, NormalDifferential, dn_dy);
    base = offsetof(LayoutOutput, surface);
    NEPHROID_EXPECT_FIELD(reader, base, SurfaceOptics, base);
    NEPHROID_EXPECT_FIELD(reader, base, SurfaceOptics, metallic);
    NEPHROID_EXPECT_FIELD(reader, base, SurfaceOptics, alpha);
    NEPHROID_EXPECT_FIELD(reader, base, SurfaceOptics, transmission);
    NEPHROID_EXPECT_FIELD(reader, base, SurfaceOptics, gloss);
    NEPHROID_EXPECT_FIELD(reader, base, SurfaceOptics, specular_tint);
    NEPHROID_EXPECT_FIELD(reader, base, SurfaceOptics, ior_from);
    NEPHROID_EXPECT_FIELD(reader, base, SurfaceOptics, ior_to);
    NEPHROID_EXPECT_FIELD(reader, base, SurfaceOptics, average_fresnel);
    NEPHROID_EXPECT_FIELD(reader, base, SurfaceOptics, conductor_ior);
    NEPHROID_EXPECT_FIELD(reader, base, SurfaceOptics, conductor_k);
    NEPHROID_EXPECT_FIELD(reader, base, SurfaceOptics, has_conductor);
    NEPHROID_EXPECT_FIELD(reader, base, SurfaceOptics, is_pane);
    NEPHROID_EXPECT_FIELD(reader, base, SurfaceOptics, is_solid);
  }
}

}  // namespace
}  // namespace nephroid::testing
