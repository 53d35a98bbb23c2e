// What a ray meets first among surfaces that are known as pictures: layers of views (frame/surface_layers.h).
//
// Steps along the ray find out where it may pass a surface. There the places in a picture nearest to the ray are looked
// up one after the other, each by the plane of the one before: Newton's method on the distance along the ray, as
// [shah-caustics-mapping] §III-C does it with the distance alone. Where a surface bends slowly against the size of a texel
// it converges within three or four steps. From the triangle that is shown there the surface itself leads on to the one
// that is met: the picture need not show it.
#ifndef NEPHROID_LAYERED_VIEW_GLSL
#define NEPHROID_LAYERED_VIEW_GLSL

#include "frame/path.glsl"

/// Where the pictures of some views lie.
struct Pictures {
  uint first_view;   // among `picture_views`
  uint view_count;
  uint layer_count;  // of each view
  float size;        // texels along a side
};

/// The triangle on which a ray starts.
struct Start {
  uint instance;
  uint triangle;
};

/// Place in the pictures.
struct PicturePlace {
  bool inside;
  uint view;    // from 0
  vec2 texels;  // from the corner
  float texel_size;  // m, of a texel on a surface across the view's direction
  vec3 forward;      // of the view
};

/// Distances between two steps, in texels, from which on they count as one place.
const float kConverged = 3.0;

/// Triangles from the one that is shown to the one that is met.
const uint kWalk = 16u;

/// A ray this near to an edge, relative to the triangle, meets both sides' triangles.
const float kOnEdge = 1e-5;

/// Steps between the ends of a ray.
const uint kSteps = 16u;

/// Of a place in the pictures of views of which no two overlap.
PicturePlace placeInPictures(Pictures pictures, vec3 place) {
  vec4 p = vec4(place, 1.0);
  vec3 clip = vec3(0.0), forward = vec3(0.0);
  float extent = 0.0;
  uint index = 0u;
  bool inside = false;
  // Without a break: the compiler then knows each view's place in the buffer, and reads it once for all threads.
  for (uint v = 0u; v < pictures.view_count; ++v) {
    PictureView view = picture_views[pictures.first_view + v];
    vec3 c = vec3(dot(view.clip_row_x, p), dot(view.clip_row_y, p), dot(view.clip_row_w, p));
    bool shows = c.z > 0.0 && max(abs(c.x), abs(c.y)) <= c.z;
    if (v == 0u || (shows && !inside)) {
      clip = c;
      forward = view.forward;
      extent = view.extent;
      index = v;
    }
    inside = inside || shows;
  }
  float inverse = inside ? 1.0 / clip.z : 0.0;
  vec2 texels = (clip.xy * inverse * 0.5 + 0.5) * pictures.size;
  return PicturePlace(inside, index, min(texels, vec2(pictures.size - 1e-3)), extent * clip.z / pictures.size, forward);
}

/// Where a ray that starts in a box leaves it.
float leaveBox(Ray ray, vec3 lower, vec3 upper) {
  vec3 dir = mix(ray.dir, vec3(1e-18), lessThan(abs(ray.dir), vec3(1e-18)));
  vec3 far = max((lower - ray.origin) / dir, (upper - ray.origin) / dir);
  return max(min(far.x, min(far.y, far.z)), 0.0);
}

/// From the triangle that a picture shows to the one that the ray meets, over the edge that it misses most by, again and
/// again: what was converged to is a texel or two away at most. At the outline of something round, where a texel shows
/// one of many triangles, it is a few steps.
/// Where very many triangles meet, as at the poles of a ball, the way may be too long: then the plane of the first one
/// serves, if the ray meets it near enough.
/// @param near  m
/// @return      nothing if the surface ends before, or bends away
Met walkToRay(Ray ray, uvec2 seen, vec3 place, float near) {
  Met none = Met(kFarAway, 0.0, 0.0, kNowhere, 0u), first = none;
  InstanceRecord instance = fetchInstance(seen.x - 1u);
  uint triangle = seen.y, before = kNowhere;
  for (uint i = 0u; i < kWalk; ++i) {
    Triangle corners = toWorld(instance, fetchTriangle(instance.first_triangle + triangle));
    RayTriangle hit = intersectPlaneOf(corners, ray.origin, ray.dir);
    float w = hit.size - hit.u - hit.v;
    float worst = min(min(hit.u, hit.v), w);
    float tolerance = kOnEdge * hit.size;
    uvec4 beyond = texelFetch(neighbour_table, int(instance.first_triangle + triangle));
    // The edges of weights v, w and u.
    uint next = hit.v == worst ? beyond.x : w == worst ? beyond.y : beyond.z;
    // Between two triangles that both say that it is just beyond the other, it is on their edge.
    if (next == before && before != kNowhere) tolerance *= 64.0;
    if (hit.size > 0.0 && worst >= -tolerance)
      return Met(hit.t / hit.size, hit.u / hit.size, hit.v / hit.size, seen.x - 1u, triangle);
    if (i == 0u && hit.size > 0.0) first = Met(hit.t / hit.size, hit.u / hit.size, hit.v / hit.size, seen.x - 1u, triangle);
    if (next == kNowhere) return none;
    if (next == before) break;
    before = triangle;
    triangle = next;
  }
  return first.t > near && length(ray.origin + first.t * ray.dir - place) <= near ? first : none;
}

/// Where a ray leaves a closed body on whose surface it starts, over the surface from the triangles beside that one:
/// for ways out that the pictures do not show, next to edges and on sides that they see edge-on.
Met walkToExit(Ray ray, Start start) {
  Met best = Met(kFarAway, 0.0, 0.0, kNowhere, 0u);
  InstanceRecord instance = fetchInstance(start.instance);
  uvec4 beside = texelFetch(neighbour_table, int(instance.first_triangle + start.triangle));
  for (uint k = 0u; k < 3u; ++k) {
    uint first = k == 0u ? beside.x : k == 1u ? beside.y : beside.z;
    if (first == kNowhere) continue;
    Met met = walkToRay(ray, uvec2(start.instance + 1u, first), ray.origin, 0.0);
    if (met.instance == kNowhere || met.triangle == start.triangle || met.t <= 0.0 || met.t >= best.t) continue;
    Triangle corners = toWorld(instance, fetchTriangle(instance.first_triangle + met.triangle));
    float out_of = dot(cross(corners.b - corners.a, corners.c - corners.a), ray.dir);
    if ((instance.flags & kInstanceMirrored) != 0u) out_of = -out_of;
    if (out_of > 0.0) best = met;
  }
  return best;
}

/// What a picture shows of a place.
struct Look {
  bool inside;       // the picture has that place
  bool shown;        // and there is a surface
  ivec3 texel;
  vec4 surface;
  float texel_size;  // m
  float behind;      // how much farther than the surface the place is, m, along the view
};

/// @param at  of the place, placeInPictures
Look lookFrom(PicturePlace at, vec3 place, Pictures pictures, sampler2DArray surfaces, uint layer) {
  ivec3 texel = ivec3(ivec2(at.texels), at.view * pictures.layer_count + layer);
  vec4 surface = texelFetch(surfaces, texel, 0);
  bool shown = at.inside && surface.x < kFarAway;
  return Look(at.inside, shown, texel, surface, at.texel_size, shown ? dot(place - surface.xyz, at.forward) : 0.0);
}

Look lookAt(vec3 place, Pictures pictures, sampler2DArray surfaces, uint layer) {
  return lookFrom(placeInPictures(pictures, place), place, pictures, surfaces, layer);
}

/// Newton's method from a place on the ray, and from where that ends over the surface to the ray.
/// @param least, most  where it is sought, m
/// @return             nothing if it leads nowhere, or to where the ray starts
Met approach(Ray ray, float first, float least, float most, Start start, Pictures pictures, usampler2DArray seen_layers,
             sampler2DArray surfaces, uint layer, uint iterations) {
  float t = first, last = first, texel_size = 0.0;
  ivec3 texel = ivec3(0);
  vec3 place = vec3(0.0);
  bool found = false, converged = false, lost = false;
  for (uint i = 0u; i < iterations && !converged && !lost; ++i) {
    Look look = lookAt(ray.origin + t * ray.dir, pictures, surfaces, layer);
    vec3 normal = unpackUnitVector(floatBitsToUint(look.surface.w));
    vec3 to = look.surface.xyz - ray.origin;
    float along = dot(normal, ray.dir);
    // Seen edge-on a plane says nothing; its distance does, as in the paper.
    float next = abs(along) > 0.02 ? dot(normal, to) / along : length(to);
    if (next < 0.0) next = length(to);
    // Past the outline of what is within another body the layer goes on with that one's far side.
    bool is_elsewhere = i > 0u && (next < 2.0 * least - most || next > 2.0 * most - least);
    if (!look.shown || is_elsewhere) {
      // Too far, or past an edge: half-way back to where something was.
      lost = i == 0u;
      t = 0.5 * (t + last);
      continue;
    }
    converged = i > 0u && abs(next - t) <= kConverged * look.texel_size;
    found = true;
    texel = look.texel;
    place = look.surface.xyz;
    texel_size = look.texel_size;
    last = t;
    t = next;
  }
  Met none = Met(kFarAway, 0.0, 0.0, kNowhere, 0u);
  if (!found) return none;
  Met met = walkToRay(ray, texelFetch(seen_layers, texel, 0).xy, place, 2.0 * texel_size);
  bool starts_there = met.instance == start.instance && met.triangle == start.triangle;
  // So near to where it starts it can only be the surface that it starts from, by rounding.
  return met.t > 1e-2 * texel_size && !starts_there ? met : none;
}

/// What all layers show of a place: a bit for each.
struct Sides {
  bool inside;
  uint shown;
  uint behind;  // the place is farther than the surface
  uint near;    // within two texels of it
  float texel_size;
};

uint bitsOf(bvec4 b) { return (b.x ? 1u : 0u) | (b.y ? 2u : 0u) | (b.z ? 4u : 0u) | (b.w ? 8u : 0u); }

/// @param depths  of the layers, four to a texel (SurfaceLayers::depths): to step along a ray takes nothing else
Sides sidesOf(vec3 place, Pictures pictures, sampler2DArray depths) {
  PicturePlace at = placeInPictures(pictures, place);
  Sides sides = Sides(at.inside, 0u, 0u, 0u, at.texel_size);
  float depth = dot(place, at.forward);
  uint texels = (pictures.layer_count + 3u) / 4u;
  for (uint i = 0u; i < texels; ++i) {
    vec4 seen = texelFetch(depths, ivec3(ivec2(at.texels), at.view * texels + i), 0);
    vec4 behind = depth - seen;
    uint shown = at.inside ? bitsOf(lessThan(seen, vec4(kFarAway))) : 0u;
    sides.shown |= shown << 4u * i;
    sides.behind |= (shown & bitsOf(greaterThan(behind, vec4(0.0)))) << 4u * i;
    sides.near |= (shown & bitsOf(lessThanEqual(abs(behind), vec4(2.0 * at.texel_size)))) << 4u * i;
  }
  return sides;
}

/// A walk along a ray, step by step.
struct March {
  uint step;
  float t_before;
  float t;
  uint shown;   // of Sides, at t
  uint behind;
  uint near;    // where it starts on a surface: the first step tells on which side
  float slack;  // m, two texels
  uint candidates;    // layers that the ray may have passed in the last step
  uint shown_at_end;  // of these, those that are shown where it ends; the others where it begins
  uint outlined;      // and those that are shown at one of its ends only,
  uint from_behind;   // and those that the ray comes to from behind
  bool hidden;      // it left the pictures before the scene
};

/// The distance after so many steps: short ones first, where surfaces are near.
float distanceAfter(uint step, float t_end) {
  float share = float(step) / float(kSteps);
  return t_end * share * share;
}

/// On to the next step in which the ray passes from one side of what is seen to the other, or past the outline of
/// something round, which bends away there.
void marchOn(inout March march, Ray ray, float t_end, float t_enough, Pictures pictures, sampler2DArray depths) {
  // A step more than to where the ray leaves the scene: what it meets there may bound the scene. That must be as long
  // as depths may be off, or one short of it passes for none.
  while (march.candidates == 0u && march.step <= kSteps && march.t - march.slack <= t_enough) {
    ++march.step;
    march.t_before = march.t;
    march.t = distanceAfter(march.step, t_end);
    if (march.step > kSteps) march.t = max(march.t, t_end + march.slack);
    Sides now = sidesOf(ray.origin + march.t * ray.dir, pictures, depths);
    uint behind = (march.behind & ~march.near) | (now.behind & march.near);
    march.candidates = ((behind ^ now.behind) & march.shown & now.shown) | (march.shown ^ now.shown);
    march.shown_at_end = now.shown;
    march.outlined = march.shown ^ now.shown;
    march.from_behind = march.shown & now.shown & behind & ~now.behind;
    if (!now.inside) {
      march.hidden = march.step <= kSteps;
      march.step = kSteps + 1u;
    }
    march.shown = now.shown;
    march.behind = now.behind;
    march.near = 0u;
    march.slack = 2.0 * now.texel_size;
  }
}

/// Halvings of a step to where an outline is: a sixteenth of it is near enough for Newton's method.
const uint kOutlineHalvings = 4u;

/// Where in a step a layer is shown, next to where it is not.
float outlineIn(March march, Ray ray, Pictures pictures, sampler2DArray surfaces, uint layer) {
  bool at_end = (march.shown_at_end >> layer & 1u) != 0u;
  float shown = at_end ? march.t : march.t_before, beside = at_end ? march.t_before : march.t;
  for (uint i = 0u; i < kOutlineHalvings; ++i) {
    float middle = 0.5 * (shown + beside);
    if (lookAt(ray.origin + middle * ray.dir, pictures, surfaces, layer).shown) shown = middle;
    else beside = middle;
  }
  return shown;
}

/// The nearest surface over all layers, by steps to where the ray may pass one, and Newton's method there.
/// @param t_end     where the ray leaves the scene
/// @param t_enough  what is met farther away does not count
/// @param asks_near  also asks layers so near to the start that their depths, of the middles of texels, do not tell on
///                   which side of them it is: light leaves the foot of a glass a fraction of a texel above a table
/// @param hidden    set if it leaves the pictures before
Met meetLayers(Ray ray, float t_end, float t_enough, Start start, Pictures pictures, usampler2DArray seen_layers,
               sampler2DArray surfaces, sampler2DArray depths, uint iterations, bool asks_near, inout bool hidden) {
  Met best = Met(kFarAway, 0.0, 0.0, kNowhere, 0u);
  Sides first = sidesOf(ray.origin, pictures, depths);
  March march =
      March(0u, 0.0, 0.0, first.shown, first.behind, first.near, 2.0 * first.texel_size, asks_near ? first.near : 0u,
            0u, 0u, 0u, false);
  while (best.instance == kNowhere &&
         ((march.step <= kSteps && march.t - march.slack <= t_enough) || march.candidates != 0u)) {
    marchOn(march, ray, t_end, t_enough, pictures, depths);
    // One layer after the other, of those that were passed in the same step.
    do {
      uint layer = uint(max(findLSB(march.candidates), 0));
      bool any_left = march.candidates != 0u;
      march.candidates &= ~(1u << layer);
      if (any_left) {
        float end = (march.shown_at_end >> layer & 1u) != 0u ? march.t : march.t_before;
        bool is_outlined = (march.outlined >> layer & 1u) != 0u, is_done = false;
        bool is_from_behind = (march.from_behind >> layer & 1u) != 0u;
        // Where a ray goes in and out again through the same layer, below the widest part of something round, Newton's
        // method leads from within it to where it goes out; from its outline, or from before, to where it goes in.
        float first = is_from_behind ? march.t_before : end;
        if (is_outlined) first = outlineIn(march, ray, pictures, surfaces, layer);
        for (uint attempt = 0u; attempt < 2u && !is_done; ++attempt) {
          float most = march.step == 0u ? march.slack : march.t;
          Met met = approach(ray, first, march.t_before, most, start, pictures, seen_layers, surfaces, layer,
                             iterations);
          // What is met lies in the step, or Newton's method has led to another place.
          bool is_in_step = met.t >= march.t_before - march.slack && met.t <= march.t + march.slack;
          if (is_in_step && met.t < best.t) best = met;
          is_done = is_in_step || first == end;
          first = end;
        }
      }
    } while (march.candidates != 0u);
  }
  hidden = hidden || (march.hidden && best.instance == kNowhere);
  return best;
}

#endif
