// Lists the photons beside which some cells are torn: one thread a square of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/deposit.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const int kSide = int(kDepositSquare);
/// Bits 5 y + x with x and y < 4.
const uint kOfPhotons = 0x7BDEFu;

/// Of cells beside the square's first photon and on, five along each side, those that are whole: bits 5 y + x.
uint wholeAround(uvec2 square) {
  uint own = wholeCells(square), left = wholeCells(square - uvec2(1u, 0u)), above = wholeCells(square - uvec2(0u, 1u));
  uint corner = wholeCells(square - 1u);
  const uint last = kDepositSquare - 1u;
  uint whole = corner >> (kDepositSquare * last + last) & 1u | (above >> (kDepositSquare * last) & 15u) << 1;
  for (uint y = 0u; y < kDepositSquare; ++y) {
    uint row = left >> (kDepositSquare * y + last) & 1u | (own >> (kDepositSquare * y) & 15u) << 1;
    whole |= row << (5u * (y + 1u));
  }
  return whole;
}

bool isValid(ivec2 at) {
  return isPhoton(at) && (texelFetch(photon_texels, int(4u * indexOf(at) + 1u)).w & kPhotonValid) != 0u;
}

void main() {
  uvec2 square = gl_GlobalInvocationID.xy + 1u;
  ivec2 first = kSide * (ivec2(square) - 1);
  if (first.x >= int(push.grid_width) || first.y >= int(push.grid_height)) return;
  uint whole = wholeAround(square);
  // Bits 5 y + x, of photons: not all four cells about it are whole.
  uint torn = ~(whole & whole >> 1 & whole >> 5 & whole >> 6) & kOfPhotons;
  for (; torn != 0u; torn &= torn - 1u) {
    uint k = uint(findLSB(torn));
    ivec2 at = first + ivec2(k % 5u, k / 5u);
    if (!isValid(at)) continue;
    uint quarters = (whole >> k & 3u | (whole >> (k + 5u) & 3u) << 2) ^ 15u;
    listed[cellCount() - 1u - atomicAdd(lists.torn_count, 1u)] = numberOf(at) | quarters << kPartShift;
  }
}
