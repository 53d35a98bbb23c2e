// The sums of all rows: one thread a kind, in order, with what rounding took from each sum added to the next term.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/caustic_map/transport.shared.h"

layout(local_size_x = 32) in;
layout(scalar, set = 0, binding = 0) readonly buffer Rows { vec3 rows[]; };
layout(scalar, set = 0, binding = 1) writeonly buffer Sums { vec3 sums[]; };

layout(push_constant, scalar) uniform Push {
  uint row_count;
  uint record;  // that is written
};

void main() {
  uint kind = gl_GlobalInvocationID.x;
  if (kind >= kLedgerKinds) return;
  vec3 sum = vec3(0.0);
  precise vec3 missing = vec3(0.0);
  for (uint row = 0u; row < row_count; ++row) {
    precise vec3 term = rows[row * kLedgerKinds + kind] - missing;
    precise vec3 next = sum + term;
    missing = (next - sum) - term;
    sum = next;
  }
  sums[record * kLedgerKinds + kind] = sum;
}
