// Colours as FLIP compares them ([andersson-2020], colour pipeline): opponent space for filters, CIELAB for distances.
#pragma once

#include "core/math.h"

namespace nephroid {

/// Linear Rec. 709 RGB to CIE XYZ, each over that of the white (1, 1, 1): every row sums to 1, so grey is (v, v, v).
/// From the primaries and the white point (0.3127, 0.3290) of ITU-R BT.709.
inline const mat3 kRelativeXyzFromRgb = glm::transpose(mat3(  //
    0.433887346F, 0.376224009F, 0.189888645F,                 //
    0.212639006F, 0.715168679F, 0.072192315F,                 //
    0.017750040F, 0.109447621F, 0.872802339F));
inline const mat3 kRgbFromRelativeXyz = glm::inverse(kRelativeXyzFromRgb);

/// YCxCz: lightness, red against green, yellow against blue; linear in light, so that filters mix light.
/// @param rgb  linear Rec. 709
/// @return     (−16 … 100, …) for RGB in [0, 1]; scaled like CIELAB
inline vec3 toOpponent(vec3 rgb) {
  const vec3 xyz = kRelativeXyzFromRgb * rgb;
  return {116.0F * xyz.y - 16.0F, 500.0F * (xyz.x - xyz.y), 200.0F * (xyz.y - xyz.z)};
}
inline vec3 fromOpponent(vec3 opponent) {
  const float y = (opponent.x + 16.0F) / 116.0F;
  return kRgbFromRelativeXyz * vec3(y + opponent.y / 500.0F, y, y - opponent.z / 200.0F);
}

/// CIELAB with the Hunt effect: a* and b* times L*/100, for colours of dim things look less colourful.
/// @param rgb  linear Rec. 709, in [0, 1]
/// @return     L* in [0, 100], and a*, b* so weighted
inline vec3 toHuntLab(vec3 rgb) {
  const auto compress = [](float t) {
    constexpr float kDelta = 6.0F / 29.0F;  // below its cube the root would be too steep, and a line goes on instead
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0F * kDelta * kDelta) + 4.0F / 29.0F;
  };
  const vec3 xyz = kRelativeXyzFromRgb * rgb;
  const float fx = compress(xyz.x), fy = compress(xyz.y), fz = compress(xyz.z);
  const float lightness = 116.0F * fy - 16.0F;
  return {lightness, 0.01F * lightness * 500.0F * (fx - fy), 0.01F * lightness * 200.0F * (fy - fz)};
}

/// HyAB: of large differences lightness and colour are judged apart, so they add.
inline float hyabDistance(vec3 lab_a, vec3 lab_b) {
  const vec3 d = lab_a - lab_b;
  return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

}  // namespace nephroid
