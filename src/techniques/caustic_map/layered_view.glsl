// What a ray meets first among surfaces that are known as pictures: layers of views (frame/surface_layers.h).
//
// The places in a picture nearest to the ray are looked up one after the other, each by the plane of the one before:
// Newton's method on the distance along the ray, as [shah-caustics-mapping] §III-C does it with the distance alone. Where a surface
// bends slowly against the size of a texel it converges within three or four steps, and then what is met is the very
// triangle's plane, not what the picture was rounded to.
#ifndef NEPHROID_LAYERED_VIEW_GLSL
#define NEPHROID_LAYERED_VIEW_GLSL

#include "frame/path.glsl"

/// Where the pictures of some views lie.
struct Pictures {
  uint first_view;   // among `layer_views`
  uint view_count;
  uint layer_count;  // of each view
  float size;        // texels along a side
};

/// Place in the pictures.
struct PicturePlace {
  bool inside;
  uint view;    // from 0
  vec2 texels;  // from the corner
  float texel_size;  // m, of a texel on a surface across the view's direction
};

/// Distances between two steps, in texels, from which on they count as one place.
const float kConverged = 1.0;

/// Steps between the ends of a ray where Newton's method finds nothing.
const uint kSteps = 16u;

/// Of a place in the world in a view's picture.
PicturePlace placeInView(ViewRecord view, uint index, vec3 place, float size) {
  vec4 p = vec4(place, 1.0);
  float x = dot(view.clip_row_x, p), y = dot(view.clip_row_y, p), w = dot(view.clip_row_w, p);
  bool inside = w > 0.0 && abs(x) <= w && abs(y) <= w;
  float inverse = inside ? 1.0 / w : 0.0;
  vec2 texels = (vec2(x, y) * inverse * 0.5 + 0.5) * size;
  return PicturePlace(inside, index, min(texels, vec2(size - 1e-3)), 2.0 * max(length(view.right), length(view.up)) * w / size);
}

/// Of a place in the pictures of views of which no two overlap.
PicturePlace placeInPictures(Pictures pictures, vec3 place) {
  PicturePlace found = PicturePlace(false, 0u, vec2(0.0), 0.0);
  for (uint v = 0u; v < pictures.view_count && !found.inside; ++v)
    found = placeInView(layer_views[pictures.first_view + v], v, place, pictures.size);
  return found;
}

/// Where a ray that starts in a box leaves it.
float leaveBox(Ray ray, vec3 lower, vec3 upper) {
  vec3 dir = mix(ray.dir, vec3(1e-18), lessThan(abs(ray.dir), vec3(1e-18)));
  vec3 far = max((lower - ray.origin) / dir, (upper - ray.origin) / dir);
  return max(min(far.x, min(far.y, far.z)), 0.0);
}

/// Where a ray meets the plane of a triangle; its weights may lie outside of it, by a texel or two.
Met meetPlaneOf(Ray ray, uvec2 seen) {
  InstanceRecord instance = fetchInstance(seen.x - 1u);
  Triangle corners = toWorld(instance, fetchTriangle(instance.first_triangle + seen.y));
  RayTriangle hit = intersectPlaneOf(corners, ray.origin, ray.dir);
  if (hit.size <= 0.0) return Met(kFarAway, 0.0, 0.0, kNowhere, 0u);
  return Met(hit.t / hit.size, hit.u / hit.size, hit.v / hit.size, seen.x - 1u, seen.y);
}

/// What a picture shows of a place.
struct Look {
  bool inside;       // the picture has that place
  bool shown;        // and there is a surface
  uvec2 seen;
  vec4 surface;
  float texel_size;  // m
  float behind;      // how much farther than the surface the place is, m, along the view
};

Look lookAt(vec3 place, Pictures pictures, usampler2DArray seen_layers, sampler2DArray surfaces, uint layer) {
  PicturePlace at = placeInPictures(pictures, place);
  Look look = Look(at.inside, false, uvec2(0u), vec4(0.0), at.texel_size, 0.0);
  if (!at.inside) return look;
  ivec3 texel = ivec3(ivec2(at.texels), at.view * pictures.layer_count + layer);
  look.seen = texelFetch(seen_layers, texel, 0).xy;
  look.surface = texelFetch(surfaces, texel, 0);
  look.shown = look.seen.x != 0u;
  look.behind = dot(place - look.surface.xyz, layer_views[pictures.first_view + at.view].forward);
  return look;
}

/// Does the surface go on beyond a texel, past its triangle's edge? There the next texel shows the same surface, or one
/// that it bends into; at an edge of the object it shows nothing, or something else.
bool goesOn(vec3 hit, Look look, Pictures pictures, usampler2DArray seen_layers, sampler2DArray surfaces, uint layer) {
  PicturePlace at = placeInPictures(pictures, hit);
  PicturePlace shown = placeInPictures(pictures, look.surface.xyz);
  vec2 outward = at.texels - shown.texels;
  float most = max(max(abs(outward.x), abs(outward.y)), 1e-6);
  vec2 next = shown.texels + outward / most;
  if (!at.inside || min(next.x, next.y) < 0.0 || max(next.x, next.y) >= pictures.size) return false;
  ivec3 texel = ivec3(ivec2(next), at.view * pictures.layer_count + layer);
  if (texelFetch(seen_layers, texel, 0).x == 0u) return false;
  vec4 surface = texelFetch(surfaces, texel, 0);
  vec3 normal = unpackUnitVector(floatBitsToUint(surface.w)), before = unpackUnitVector(floatBitsToUint(look.surface.w));
  return dot(normal, before) > 0.5 && abs(dot(normal, hit - surface.xyz)) <= look.texel_size;
}

/// Newton's method from a place on the ray. @return  nothing if it does not converge, or where the ray starts
Met approach(Ray ray, float start, Pictures pictures, usampler2DArray seen_layers, sampler2DArray surfaces, uint layer,
             uint iterations) {
  Met none = Met(kFarAway, 0.0, 0.0, kNowhere, 0u);
  float t = start, last = start;
  for (uint i = 0u; i < iterations; ++i) {
    Look look = lookAt(ray.origin + t * ray.dir, pictures, seen_layers, surfaces, layer);
    if (!look.shown) {
      // Too far, or past an edge: half-way back to where something was.
      if (i == 0u) return none;
      t = 0.5 * (t + last);
      continue;
    }
    vec3 normal = unpackUnitVector(floatBitsToUint(look.surface.w));
    vec3 to = look.surface.xyz - ray.origin;
    float along = dot(normal, ray.dir);
    // Seen edge-on a plane says nothing; its distance does, as in the paper.
    float next = abs(along) > 0.02 ? dot(normal, to) / along : length(to);
    if (next < 0.0) next = length(to);
    last = t;
    if (abs(next - t) <= kConverged * look.texel_size && i > 0u) {
      Met met = meetPlaneOf(ray, look.seen);
      // Not the surface that the ray starts from.
      if (met.instance == kNowhere || met.t <= 2.0 * look.texel_size) return none;
      bool is_inside = min(min(met.u, met.v), 1.0 - met.u - met.v) >= -1e-4;
      vec3 hit = ray.origin + met.t * ray.dir;
      if (!is_inside && !goesOn(hit, look, pictures, seen_layers, surfaces, layer)) return none;
      return met;
    }
    t = next;
  }
  return none;
}

/// Along a ray, the surface of one layer: by Newton's method, and where that finds none by steps, looking for where the
/// ray passes from one side of what is seen to the other, and Newton's method there.
/// @param t_end   where the ray leaves the scene
/// @param hidden  set if it leaves the pictures before
Met meetLayer(Ray ray, float t_end, Pictures pictures, usampler2DArray seen_layers, sampler2DArray surfaces, uint layer,
              uint iterations, inout bool hidden) {
  Met met = approach(ray, 0.0, pictures, seen_layers, surfaces, layer, iterations);
  if (met.instance != kNowhere) return met;
  Look before = lookAt(ray.origin, pictures, seen_layers, surfaces, layer);
  float t_before = 0.0;
  for (uint i = 1u; i <= kSteps && met.instance == kNowhere; ++i) {
    float t = t_end * float(i) / float(kSteps);
    Look look = lookAt(ray.origin + t * ray.dir, pictures, seen_layers, surfaces, layer);
    if (!look.inside) {
      hidden = true;
      return met;
    }
    if (before.shown && look.shown && (before.behind > 0.0) != (look.behind > 0.0)) {
      float share = before.behind / (before.behind - look.behind);
      met = approach(ray, mix(t_before, t, share), pictures, seen_layers, surfaces, layer, iterations);
      // Past an edge nothing is met.
      if (met.t < t_before || met.t > t + look.texel_size) met = Met(kFarAway, 0.0, 0.0, kNowhere, 0u);
    }
    before = look;
    t_before = t;
  }
  return met;
}

/// The nearest over all layers.
Met meetLayers(Ray ray, float t_end, Pictures pictures, usampler2DArray seen_layers, sampler2DArray surfaces,
               uint iterations, inout bool hidden) {
  Met best = Met(kFarAway, 0.0, 0.0, kNowhere, 0u);
  for (uint layer = 0u; layer < pictures.layer_count; ++layer) {
    Met met = meetLayer(ray, t_end, pictures, seen_layers, surfaces, layer, iterations, hidden);
    if (met.t < best.t) best = met;
  }
  return best;
}

#endif
