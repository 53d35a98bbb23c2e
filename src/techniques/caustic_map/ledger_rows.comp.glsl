// Sums of photons' accounts and ends, some photons in a row to a thread: always the same order.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/caustic_map/transport.shared.h"
#define NEPHROID_PHOTON_BINDING 0
#include "frame/photons.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 1) readonly buffer Accounts { PhotonAccount accounts[]; };
layout(scalar, set = 0, binding = 2) writeonly buffer Rows { vec3 rows[]; };

layout(push_constant, scalar) uniform Push {
  uint photon_count;
  uint row_count;
};

void main() {
  uint row = gl_GlobalInvocationID.x;
  if (row >= row_count) return;
  vec3 sums[kLedgerKinds];
  for (uint k = 0u; k < kLedgerKinds; ++k) sums[k] = vec3(0.0);
  for (uint i = row * kLedgerRow; i < min((row + 1u) * kLedgerRow, photon_count); ++i) {
    PhotonAccount a = accounts[i];
    sums[0] += a.emitted;
    sums[1] += a.blocked;
    sums[2] += a.absorbed;
    sums[3] += a.diffuse;
    sums[4] += a.other_way;
    sums[5] += a.internal;
    sums[6] += a.normal;
    sums[7] += a.microfacet;
    sums[8] += a.landed;
    uint outcome = (photons[i].light_band_flags & 255u) >> kOutcomeShift;
    sums[kAccountKinds + min(outcome, kOutcomeCount - 1u)] += photons[i].flux;
  }
  for (uint k = 0u; k < kLedgerKinds; ++k) rows[row * kLedgerKinds + k] = sums[k];
}
