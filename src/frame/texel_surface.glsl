// The surface that a texel of a view's picture shows, the world area that it covers, and whether flux may lie on it.
//
// The including shader gives `views`, uniforms of ViewRecords, and `kViewCount`. Views of several are faces of one cube:
// what does not tell them apart is read of the first, whose place is a constant, since devices without registers to
// spare for each thread read such words once.
#ifndef NEPHROID_TEXEL_SURFACE_GLSL
#define NEPHROID_TEXEL_SURFACE_GLSL

#include "frame/frame.shared.h"
#include "core/optics/lights.shared.h"
#include "core/optics/photon.shared.h"

/// The rows of a view's matrix that say where on its picture a place is.
struct Projection {
  vec4 x;
  vec4 y;
  vec4 w;
};

Projection projectionOf(uint v) {
  Projection p = Projection(views[0].clip_row_x, views[0].clip_row_y, views[0].clip_row_w);
  [[unroll]] for (uint i = 1u; i < kViewCount; ++i)
    if (i == v) p = Projection(views[i].clip_row_x, views[i].clip_row_y, views[i].clip_row_w);
  return p;
}

/// Of a place on a view's picture, in texels from its corner.
struct OnPicture {
  vec2 texels;
  float w;  // > 0: before the eye
};

/// The rows place a pixel's sample in its middle, wherever in the pixel it is.
OnPicture onPicture(Projection projection, vec3 place, vec2 size) {
  vec4 p = vec4(place, 1.0);
  float w = dot(projection.w, p);
  vec2 at = vec2(dot(projection.x, p), dot(projection.y, p)) / max(w, 1e-30);
  return OnPicture((at * 0.5 + 0.5) * size + vec2(views[0].film_x, views[0].film_y) - 0.5, w);
}

bool isOnPicture(OnPicture on, vec2 size) {
  return on.w > 0.0 && all(greaterThanEqual(on.texels, vec2(0.0))) && all(lessThan(on.texels, size));
}

/// What a texel shows.
struct TexelSurface {
  vec3 position;     // world; far away where nothing is seen
  vec3 lit_normal;   // unit, on the side that faces the view's eye
  float cos_view;    // of the angle between that and the way to the eye
  float distance_2;  // m², to the eye
};

/// From the eye to a place, of any length. No branch: lavapipe compiles a shader anew, at times each time, for the
/// uniforms that alone decide one.
/// @param forward  of the view, if it is parallel
vec3 lookAt(vec3 place, vec3 forward) {
  return mix(place - views[0].eye, forward, bvec3(views[0].is_orthographic != 0u));
}

/// @param forward  of the view, if it is parallel
TexelSurface describeTexel(vec4 texel, vec3 forward) {
  vec3 normal = unpackUnitVector(floatBitsToUint(texel.w)), along = lookAt(texel.xyz, forward);
  float distance_2 = dot(along, along);
  float cos_view = dot(normal, along) * inversesqrt(max(distance_2, 1e-37));
  return TexelSurface(texel.xyz, cos_view > 0.0 ? -normal : normal, abs(cos_view), distance_2);
}

TexelSurface describeTexel(vec4 texel) { return describeTexel(texel, views[0].forward); }

/// Along a packed unit vector, between 0.57 and 1 long: without the root that its length takes.
vec3 unpackDirection(uint packed_vector) {
  vec2 p = unpackSnorm2x16(packed_vector);
  float z = 1.0 - abs(p.x) - abs(p.y), fold = max(-z, 0.0);
  return vec3(p - vec2(p.x >= 0.0 ? fold : -fold, p.y >= 0.0 ? fold : -fold), z);
}

/// Whether a texel's surface is lit by light of a direction that falls on it at either of two places: lies it on the
/// surface's plane, but for what that bends over `reach`, and comes it from the side that the view sees?
/// @param texel    as describeTexel
/// @param forward  of the view, if it is parallel
bool isLitAt(vec4 texel, vec3 forward, vec3 first, vec3 second, float reach, vec3 direction) {
  vec3 normal = unpackDirection(floatBitsToUint(texel.w)), along = lookAt(texel.xyz, forward);
  float off = min(abs(dot(normal, first - texel.xyz)), abs(dot(normal, second - texel.xyz)));
  return off * off <= reach * reach * dot(normal, normal) && dot(normal, along) * dot(normal, direction) > 0.0;
}

/// Size of a texel across the view, m.
float texelSize(float w, vec2 size) {
  return 2.0 * max(length(views[0].right) / size.x, length(views[0].up) / size.y) * w;
}

/// World area that the texel covers on the surface, m²: ω·d²/cos θ, of parallel light A/cos θ (DESIGN §2).
float texelArea(TexelSurface s, vec2 texels, vec2 size) {
  float area = 4.0 * length(views[0].right) * length(views[0].up) / (size.x * size.y);
  vec2 film = texels / size * 2.0 - 1.0;
  float of_cone = cellSolidAngle(film.x * length(views[0].right), film.y * length(views[0].up), area) * s.distance_2;
  return (views[0].is_orthographic != 0u ? area : of_cone) / max(s.cos_view, 1e-3);
}

/// Whether a place lies on the surface of a texel: on its plane, but for what the surface bends over `reach`.
bool liesOn(TexelSurface s, vec3 place, float reach) {
  return abs(dot(s.lit_normal, place - s.position)) <= reach;
}

#endif
