// Draws the triangles that were put off.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/raster.glsl"

layout(local_size_x = 64) in;

void main() {
  uint several = min(counts[countOf(push.list, kCountPutOff)], push.part_capacity);
  uint count = several + counts[countOf(push.list, kCountWholes)];
  uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  for (uint i = gl_GlobalInvocationID.x; i < count; i += threads) {
    RasterPart part = parts[i < several ? i : push.part_capacity + (i - several)];
    draw(projectPart(part), part.number);
  }
}
