// Every function of photon.shared.h on one input, for the device and for C++. No include guard: its test compiles it
// twice.
#include "core/optics/photon.shared.h"

NEPHROID_NAMESPACE_BEGIN

// Integers come as floats below 2^16, which hold them exactly.
struct PhotonInput {
  vec3 axis_a;
  vec3 axis_b;
  vec3 n;
  vec3 unit;
  float upper;
  float lower;
  float flags;
};

struct PhotonOutput {
  uint light_band_flags;
  uint light;
  uint band;
  uint flags;
  uint has_flag;
  uint mixed;
  uint chain;
  uint packed_unit;
  vec3 unpacked_unit;
  vec3 perpendicular;
  vec2 major_direction;
  uint footprint_flags;
  float footprint_major;
  float footprint_minor;
  uint footprint_orientation;
  vec3 footprint_axis_a;
  vec3 footprint_axis_b;
};

NEPHROID_FN PhotonOutput evaluatePhoton(PhotonInput given) {
  uint upper = uint(given.upper);
  uint lower = uint(given.lower);
  uint word = (upper << 16) | lower;
  Photon photon;
  photon.light_band_flags = packLightBandFlags(upper, lower & 255u, uint(given.flags));
  PhotonOutput result;
  result.light_band_flags = photon.light_band_flags;
  result.light = photonLight(photon);
  result.band = photonBand(photon);
  result.flags = photonFlags(photon);
  result.has_flag = hasPhotonFlag(photon, kPhotonLeftScene) ? 1u : 0u;
  result.mixed = mixBits(word);
  result.chain = hashChain(word, lower);
  result.packed_unit = packUnitVector(given.unit);
  result.unpacked_unit = unpackUnitVector(word);
  result.perpendicular = perpendicularTo(given.n);
  result.major_direction = majorDirection(vec2(given.axis_a.x, given.axis_a.y), vec2(given.axis_b.x, given.axis_b.y));
  photon = setPhotonFootprint(photon, given.axis_a, given.axis_b, given.n);
  Footprint footprint = photonFootprint(photon, given.n);
  result.footprint_flags = photonFlags(photon);
  result.footprint_major = photon.footprint_major;
  result.footprint_minor = photon.footprint_minor;
  result.footprint_orientation = photon.footprint_orientation;
  result.footprint_axis_a = footprint.axis_a;
  result.footprint_axis_b = footprint.axis_b;
  return result;
}

NEPHROID_NAMESPACE_END
