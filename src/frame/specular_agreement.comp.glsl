// Which cells' corners agree on what a chain ends on, so that the pixels between them show what lies between there.
//
// They agree if they met the same surfaces in the same order and end on the same triangle, and if the ends lie so evenly,
// judged by the points beside, that a pixel is shown what is at most kMostDisplaced away from what it sees. How the ends
// bend between the corners is known from there too and left to those who interpolate. Pixels of other cells are followed
// themselves.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/specular_push.glsl"
#define NEPHROID_GRID_BINDINGS 7
#include "frame/specular_grid.glsl"
#define NEPHROID_ENDS_BINDING 9
#include "frame/specular_ends.glsl"
#include "frame/specular_others.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 10, rgba32ui) writeonly uniform uimageBuffer stored_bends;
layout(constant_id = 9) const bool kSceneTransmits = true;

/// Pixels.
const float kMostDisplaced = 0.5;
/// By how much interpolation may miss an end's weight: a share of it, or of all light that a pixel shows.
const float kMostWeightError = 0.02;
const float kMostLightError = 0.003;
/// What is passed by between the corners may carry more than the mean of what is at the corners.
const float kOthersMargin = 1.1;

/// A value at a point of the grid, and whether it tells anything of the cell.
struct Sample {
  bool valid;
  vec4 value;  // place, luminance of the weight
  float at;    // pixel along the line
};

float luminanceOf(vec3 rgb) { return dot(rgb, vec3(0.2126, 0.7152, 0.0722)); }

/// Steps from pixel to pixel.
struct Steps {
  vec3 per_x;
  vec3 per_y;
};

/// How many pixels away from its own place a pixel shows what lies `miss` beside, by the steps between pixels.
float pixelsOf(vec3 miss, Steps steps) {
  float longest = max(dot(steps.per_x, steps.per_x), dot(steps.per_y, steps.per_y));
  float scale = longest > 0.0 ? inversesqrt(longest) : 0.0;
  vec3 m = scale * miss, x = scale * steps.per_x, y = scale * steps.per_y, normal = cross(x, y);
  float squared = dot(normal, normal);
  if (squared == 0.0) return miss == vec3(0.0) ? 0.0 : 1e9;
  return length(vec2(dot(cross(m, y), normal), dot(cross(x, m), normal))) / squared;
}

/// How a value bends between the middle two of four samples on a line.
struct Bend {
  bool known;
  vec4 second;  // second difference, of steps as long as from the one to the other
  vec4 doubt;   // what interpolation by it may miss
};

/// From one side only: the bend may be another on the other side, so all that a straight line would miss is in doubt.
const float kDoubtOfOne = 1.0 / 8.0;
/// From both sides the cubic term is known to be left out, which is 1/125 of the difference at the most; five times as
/// much covers what is not known.
const float kDoubtOfBoth = 1.0 / 24.0;

Bend estimateBend(Sample before, Sample first, Sample second, Sample after) {
  float h = second.at - first.at, to_before = max(first.at - before.at, 1.0), to_after = max(after.at - second.at, 1.0);
  vec4 slope = (second.value - first.value) / h;
  vec4 of_before = (slope - (first.value - before.value) / to_before) * (2.0 * h * h / (h + to_before));
  vec4 of_after = ((after.value - second.value) / to_after - slope) * (2.0 * h * h / (h + to_after));
  vec4 of_one = before.valid ? of_before : of_after;
  bool both = before.valid && after.valid;
  Bend bend;
  bend.known = before.valid || after.valid;
  bend.second = both ? 0.5 * (of_before + of_after) : of_one;
  bend.doubt = both ? kDoubtOfBoth * (of_after - of_before) : kDoubtOfOne * of_one;
  return bend;
}

/// @param chain_hash  of the cell's first corner
Sample sampleAt(ivec2 point, uint chain, uint chain_hash, bool across) {
  bool inside = all(greaterThanEqual(point, ivec2(0))) && all(lessThan(point, ivec2(pointCount())));
  uvec2 p = uvec2(max(point, ivec2(0)));
  uvec4 place = fetchEndPlace(p, chain);
  uvec2 pixel = pixelOfPoint(p);
  return Sample(inside && place.w == chain_hash,
                vec4(uintBitsToFloat(place.xyz), luminanceOf(fetchEndWeight(p, chain).xyz)),
                float(across ? pixel.x : pixel.y));
}

/// What is known of a value along one direction of a cell.
struct Course {
  bool known;
  vec4 bend;
  float pixels;  // by which interpolation may displace what is shown
  float weight;  // by which it may miss its weight
};

/// Along the two edges of a cell that go in one direction.
Course findCourse(ivec2 cell, ivec2 along, uint chain, uint chain_hash, Steps steps) {
  Bend bends[2];
  bool across = along.x != 0;
  for (int side = 0; side < 2; ++side) {
    ivec2 first = cell + side * (ivec2(1) - along);
    Sample before = sampleAt(first - along, chain, chain_hash, across), a = sampleAt(first, chain, chain_hash, across);
    Sample b = sampleAt(first + along, chain, chain_hash, across);
    Sample after = sampleAt(first + 2 * along, chain, chain_hash, across);
    // Points that the picture's edge pushed onto one pixel tell nothing.
    before.valid = before.valid && before.at < a.at;
    after.valid = after.valid && after.at > b.at;
    bends[side] = estimateBend(before, a, b, after);
  }
  // Between the edges the mean of both is taken.
  vec4 differ = (bends[1].second - bends[0].second) / 16.0;
  Course course;
  course.known = bends[0].known && bends[1].known;
  course.bend = 0.5 * (bends[0].second + bends[1].second);
  course.pixels = max(pixelsOf(bends[0].doubt.xyz, steps), pixelsOf(bends[1].doubt.xyz, steps)) +
                  pixelsOf(differ.xyz, steps);
  course.weight = max(abs(bends[0].doubt.w), abs(bends[1].doubt.w)) + abs(differ.w);
  return course;
}

/// What is known of a cell's chain.
struct Agreement {
  bool agrees;
  bool lit;         // it shows something
  Bilinear weight;  // and what others carry
  vec4 bend_x;      // of place and luminance
  vec4 bend_y;
};

Agreement agreementOf(uvec2 cell, Cell pixels, uint chain) {
  uvec4 place = fetchEndPlace(cell, chain), right = fetchEndPlace(cell + uvec2(1u, 0u), chain),
        below = fetchEndPlace(cell + uvec2(0u, 1u), chain), opposite = fetchEndPlace(cell + 1u, chain);
  vec4 weight = fetchEndWeight(cell, chain), weight_right = fetchEndWeight(cell + uvec2(1u, 0u), chain),
       weight_below = fetchEndWeight(cell + uvec2(0u, 1u), chain), weight_opposite = fetchEndWeight(cell + 1u, chain);
  Agreement a;
  a.bend_x = a.bend_y = vec4(0.0);
  a.weight = bilinearOf(weight, weight_right, weight_below, weight_opposite);
  a.agrees = place.w != 0u && all(equal(uvec3(right.w, below.w, opposite.w), uvec3(place.w)));
  a.lit = weight.xyz != vec3(0.0) || weight_right.xyz != vec3(0.0) || weight_below.xyz != vec3(0.0) ||
          weight_opposite.xyz != vec3(0.0);
  if (!a.agrees || !a.lit) return a;
  vec2 size = vec2(pixels.last - pixels.first);
  vec3 corner = uintBitsToFloat(place.xyz);
  Steps steps = Steps((uintBitsToFloat(right.xyz) - corner) / size.x, (uintBitsToFloat(below.xyz) - corner) / size.y);
  Course across = findCourse(ivec2(cell), ivec2(1, 0), chain, place.w, steps);
  Course down = findCourse(ivec2(cell), ivec2(0, 1), chain, place.w, steps);
  a.bend_x = across.bend;
  a.bend_y = down.bend;
  float least = min(min(luminanceOf(weight.xyz), luminanceOf(weight_right.xyz)),
                    min(luminanceOf(weight_below.xyz), luminanceOf(weight_opposite.xyz)));
  a.agrees = across.known && down.known && across.pixels + down.pixels <= kMostDisplaced &&
             across.weight + down.weight <= max(kMostWeightError * least, kMostLightError);
  return a;
}

/// Is a pixel drawn to show what a chain passed by?
bool deviates(Agreement a, uvec2 pixel, vec2 at, uint chain) {
  return drawOther(pixel, push.frame, chain) < kOthersMargin * valueAt(a.weight, at).w;
}

/// What of a pixel is to be followed, as flags of the list.
uint findFlags(Agreement reflected, Agreement transmitted, uvec2 pixel, vec2 at) {
  uint flags = kSceneTransmits ? 0u : kNoTransmitted;
  if (reflected.agrees) flags |= deviates(reflected, pixel, at, kReflected) ? kReflectedPassesBy : kNoReflected;
  if (kSceneTransmits && transmitted.agrees)
    flags |= deviates(transmitted, pixel, at, kTransmitted) ? kTransmittedPassesBy : kNoTransmitted;
  return flags;
}

const uint kNothing = kNoReflected | kNoTransmitted;

void listPixels(Cell pixels, Agreement reflected, Agreement transmitted) {
  vec2 inverse_size = 1.0 / vec2(pixels.last - pixels.first);
  uvec2 size = pixels.end - pixels.first, pixel = pixels.first, following = pixel;
  // Where all are followed they come one behind the other: threads that go in step find the same things there.
  bool all_are = !reflected.agrees || (kSceneTransmits && !transmitted.agrees);
  uint next = all_are ? extend(kFollowedPixels, size.x * size.y) : 0u;
  bool more;
  do {
    uint flags = findFlags(reflected, transmitted, pixel, vec2(pixel - pixels.first) * inverse_size);
    more = nextPixel(pixels, following);
    if (!all_are && (flags & kNothing) != kNothing) next = extend(kFollowedPixels, 1u);
    if ((flags & kNothing) != kNothing) listed[next++] = packPlace(pixel) | flags;
    pixel = following;
  } while (more);
}

void listLit(Agreement a, uint packed_place, uint chain) {
  if (!a.agrees || !a.lit) return;
  listed[extend(kLitCells + chain, 1u)] = packed_place;
  uvec2 cell = unpackPlace(packed_place);
  imageStore(stored_bends, texelOfBend(cell, chain, 0u), floatBitsToUint(a.bend_x));
  imageStore(stored_bends, texelOfBend(cell, chain, 1u), floatBitsToUint(a.bend_y));
}

void sortCell(uint packed_place) {
  uvec2 cell = unpackPlace(packed_place);
  Cell pixels = cellAt(cell);
  Agreement reflected = agreementOf(cell, pixels, kReflected), transmitted;
  transmitted.agrees = true;
  transmitted.lit = false;
  transmitted.bend_x = transmitted.bend_y = vec4(0.0);
  transmitted.weight = Bilinear(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  if (kSceneTransmits) transmitted = agreementOf(cell, pixels, kTransmitted);
  listLit(reflected, packed_place, kReflected);
  if (kSceneTransmits) listLit(transmitted, packed_place, kTransmitted);
  listPixels(pixels, reflected, transmitted);
}

void main() {
  uint first = firstOf(kCells), count = heads[kCells].count, i = firstListed();
  if (i >= count) return;
  do {
    sortCell(listed[first + i]);
    i += listedThreads();
  } while (i < count);
}
