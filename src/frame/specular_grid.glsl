// The grid over the picture at whose points chains of surfaces are followed for all pixels of a cell, and the lists of
// what there is to do.
//
// Cell (i, j) reaches from point (i, j) to point (i + 1, j + 1); points are pixels, `kSpacing` apart but at the
// picture's edges. The including shader declares before: Push, with `shift`, and gives the two bindings from
// NEPHROID_GRID_BINDINGS on: the picture of what is seen, and the lists.
#ifndef NEPHROID_SPECULAR_GRID_GLSL
#define NEPHROID_SPECULAR_GRID_GLSL

#include "frame/tables.glsl"

struct ListHead {
  uint groups_x;  // of the pass that goes through the list
  uint groups_y;
  uint groups_z;
  uint count;
};

layout(set = 0, binding = NEPHROID_GRID_BINDINGS, rg32ui) readonly uniform uimage2D seen_image;
layout(scalar, set = 0, binding = NEPHROID_GRID_BINDINGS + 1) buffer Lists { ListHead heads[6]; uint listed[]; };

/// Pixels between two points; 1: every pixel is followed, and there are no cells.
layout(constant_id = 18) const uint kSpacing = 4u;

// The two chains of a pixel: which way they leave its first surface.
const uint kReflected = 0u;
const uint kTransmitted = 1u;

// Lists, of what is packed by packPlace.
const uint kFollowedPixels = 0u;
const uint kPoints = 1u;
const uint kCells = 2u;
const uint kLitCells = 3u;  // of chain kReflected; the next is of kTransmitted
const uint kMixedCells = 5u;

// Of a followed pixel: chains that are shown otherwise.
const uint kNoReflected = 1u << 15;
const uint kNoTransmitted = 1u << 31;
// Chains of which the way that carries most is shown otherwise, but not what it passes by.
const uint kReflectedPassesBy = 1u << 14;
const uint kTransmittedPassesBy = 1u << 30;

uvec2 pictureSize() { return uvec2(imageSize(seen_image)); }

/// Points along both sides, whatever the shift.
uvec2 pointCount() { return (pictureSize() + 2u * kSpacing - 2u) / kSpacing + 1u; }

uvec2 pixelOfPoint(uvec2 point) {
  ivec2 pixel = ivec2(point * kSpacing) - ivec2(shift);
  return uvec2(clamp(pixel, ivec2(0), ivec2(pictureSize()) - 1));
}

/// Pixels of a cell.
struct Cell {
  uvec2 first;
  uvec2 end;   // one past its last pixel
  uvec2 last;  // the pixel of the point that it reaches to
};

Cell cellAt(uvec2 cell) {
  uvec2 first = pixelOfPoint(cell), last = pixelOfPoint(cell + 1u);
  // The pixels of the picture's last row and column belong to the cells that reach them.
  return Cell(first, last + uvec2(equal(last, pictureSize() - 1u)), last);
}

/// Goes on to the next pixel of a cell, row by row. @return  false: that was the last
bool nextPixel(Cell cell, inout uvec2 pixel) {
  ++pixel.x;
  bool row_ends = pixel.x >= cell.end.x;
  pixel = row_ends ? uvec2(cell.first.x, pixel.y + 1u) : pixel;
  return pixel.y < cell.end.y;
}

uint packPlace(uvec2 place) { return place.x | (place.y << 16); }
uvec2 unpackPlace(uint packed_place) { return uvec2(packed_place & 0x3FFFu, packed_place >> 16 & 0x3FFFu); }

uint firstOf(uint list) {
  uvec2 size = pictureSize(), points = pointCount();
  uint pixels = size.x * size.y;
  return list < kPoints ? 0u : pixels + (list - kPoints) * (points.x * points.y);
}

/// Threads of a group that goes through a list, and how many groups there are at the most: a list that is longer is gone
/// through in turns.
const uint kListGroup = 64u;
const uint kMaxListGroups = 16384u;

/// Makes room for some at the end of a list. @return  where in `listed` it begins
uint extend(uint list, uint count) {
  uint first = atomicAdd(heads[list].count, count);
  atomicMax(heads[list].groups_x, min((first + count + kListGroup - 1u) / kListGroup, kMaxListGroups));
  return firstOf(list) + first;
}

/// Of this thread in a list. The groups of both halves alternate: a device that gives each of its cores a range of groups
/// so gives it what lies in many places of the list.
uint firstListed() {
  uint half_count = (gl_NumWorkGroups.x + 1u) / 2u;
  uint group = gl_WorkGroupID.x < half_count ? 2u * gl_WorkGroupID.x : 2u * (gl_WorkGroupID.x - half_count) + 1u;
  return group * kListGroup + gl_LocalInvocationID.x;
}
uint listedThreads() { return gl_NumWorkGroups.x * kListGroup; }

/// Does an instance have a lobe of class S?
bool isSpecular(uint instance) {
  uint material = texelFetch(instance_table, int(5u * instance + 3u)).y;
  return (texelFetch(material_table, int(9u * material + 3u)).w & kMaterialIsSpecular) != 0u;
}

#endif
