// Which triangle each pixel sees, now that the nearest depths are known: of those equally near the first in number.
//
// Who finds a pixel claimed by a later number writes over it, but nobody knows whose write comes last. So all who
// did that write once more, in a second run.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/raster.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 5) const bool kOfParts = false;
layout(constant_id = 6) const bool kSettles = false;
layout(scalar, set = 0, binding = 11) buffer Overtaking { uint overtaking[]; };  // likewise
layout(scalar, set = 0, binding = 12) buffer Numbers { uint numbers[]; };        // by pixel, of the triangle
layout(scalar, set = 0, binding = 13) buffer Seen { uvec2 seen[]; };             // instance + 1, triangle

void show(FilmTriangle t, uint item, uint number, uvec2 name) {
  bool overtakes = false;
  for (ivec2 p = findCovered(t, t.first); p.y <= t.last.y; p = findCovered(t, nextPixel(t, p))) {
    uint depth = depthAt(t, p), index = indexOf(p);
    if (depth != depths[index]) continue;
    uint before = kSettles ? numbers[index] : atomicMin(numbers[index], number);
    if (kSettles ? before == number : before > number) seen[index] = name;
    if (before > number && before != kNoNumber) overtakes = true;
  }
  if (overtakes && !kSettles)
    overtaking[push.first_number + atomicAdd(counts[countOf(push.list, kCountOvertaking)], 1u)] = item;
}

void main() {
  InstanceRecord instance = fetchInstance(push.instance);
  uint count = counts[countOf(push.list, kSettles ? kCountOvertaking : kCountNearest)];
  uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  for (uint i = gl_GlobalInvocationID.x; i < count; i += threads) {
    uint item = kSettles ? overtaking[push.first_number + i] : items[push.first_number + i];
    if (kOfParts) {
      RasterPart part = parts[item];
      show(projectPart(part), item, part.number, uvec2(part.instance + 1u, part.triangle));
    } else {
      show(projectTriangle(fetchCorners(instance, item)), item, push.first_number + item,
           uvec2(push.instance + 1u, item));
    }
  }
}
