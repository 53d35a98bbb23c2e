// What the passes of frame/raster.h share with C++. Scalar block layout.
#ifndef NEPHROID_RASTER_SHARED_H
#define NEPHROID_RASTER_SHARED_H

#include "frame/frame.shared.h"

NEPHROID_NAMESPACE_BEGIN

struct RasterPush {
  // Clip from world, column by column, with x and y in pixels from the film's middle.
  vec4 clip_column_x;
  vec4 clip_column_y;
  vec4 clip_column_z;
  vec4 clip_column_w;
  int size_x;  // of the picture
  int size_y;
  float guard;  // corners this far from the film's middle are projected, in pixels
  uint part_capacity;
  uint part_list;  // the list of all parts
  uint draw_count;
  int first_x;  // the pixel from which on there may be something
  int first_y;
  // Of the draw, or of all parts.
  uint instance;
  uint triangle_count;
  uint list;
  uint first_number;  // of its triangles, counted through all draws
};

/// A triangle that was put off, or some rows of it.
struct RasterPart {
  uint instance;
  uint triangle;
  uint number;  // of the triangle, counted through all draws
  uint rows;    // of the picture: the first, and from bit 16 on how many
};

/// More pixels than this in its box, and a triangle is drawn in parts of about so many.
NEPHROID_CONST int kPartPixels = 64;

NEPHROID_CONST uint kAllRows = 0xFFFF0000u;

// Each draw has a list of triangles, and all parts have some too. Their lengths, by list:
NEPHROID_CONST uint kCountPutOff = 0u;  // of a draw: triangles too large for one thread; of parts: parts in all
NEPHROID_CONST uint kCountWholes = 1u;  // of parts: triangles for whose parts there was no room
NEPHROID_CONST uint kCounts = 2u;

NEPHROID_NAMESPACE_END

#endif
