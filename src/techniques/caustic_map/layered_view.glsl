// What a ray meets first among surfaces that are known as pictures: layers of views (frame/surface_layers.h).
//
// The places in a picture nearest to the ray are looked up one after the other, each by the plane of the one before:
// Newton's method on the distance along the ray, as [shah-caustics-mapping] §III-C does it with the distance alone.
// Where a surface bends slowly against the size of a texel it converges within three or four steps. From the triangle
// that is shown there the surface itself leads on to the one that is met: the picture need not show it.
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
};

/// Distances between two steps, in texels, from which on they count as one place.
const float kConverged = 3.0;

/// Triangles from the one that is shown to the one that is met.
const uint kWalk = 16u;

/// A ray this near to an edge, relative to the triangle, meets both sides' triangles.
const float kOnEdge = 1e-5;

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
    uvec4 beyond = texelFetch(neighbour_table, texelOf(instance.first_triangle + triangle), 0);
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

/// Newton's method from a place on the ray, and from where that ends over the surface to the ray.
/// @return  nothing if it leads nowhere, or to where the ray starts
Met approach(Ray ray, float first, Start start, Pictures pictures, usampler2DArray seen_layers,
             sampler2DArray surfaces, uint layer, uint iterations) {
  float t = first, last = first;
  uvec2 seen = uvec2(0u);
  vec3 place = vec3(0.0);
  float texel_size = 0.0;
  bool converged = false, lost = false;
  for (uint i = 0u; i < iterations && !converged && !lost; ++i) {
    Look look = lookAt(ray.origin + t * ray.dir, pictures, seen_layers, surfaces, layer);
    if (!look.shown) {
      // Too far, or past an edge: half-way back to where something was.
      lost = i == 0u;
      t = 0.5 * (t + last);
      continue;
    }
    vec3 normal = unpackUnitVector(floatBitsToUint(look.surface.w));
    vec3 to = look.surface.xyz - ray.origin;
    float along = dot(normal, ray.dir);
    // Seen edge-on a plane says nothing; its distance does, as in the paper.
    float next = abs(along) > 0.02 ? dot(normal, to) / along : length(to);
    if (next < 0.0) next = length(to);
    converged = i > 0u && abs(next - t) <= kConverged * look.texel_size;
    seen = look.seen;
    place = look.surface.xyz;
    texel_size = look.texel_size;
    last = t;
    t = next;
  }
  Met none = Met(kFarAway, 0.0, 0.0, kNowhere, 0u);
  if (seen.x == 0u) return none;
  Met met = walkToRay(ray, seen, place, 2.0 * texel_size);
  bool starts_there = met.instance == start.instance && met.triangle == start.triangle;
  // So near to where it starts it can only be the surface that it starts from, by rounding.
  return met.t > 1e-2 * texel_size && !starts_there ? met : none;
}

/// Along a ray, the surface of one layer: by Newton's method, and where that finds none by steps, looking for where the
/// ray passes from one side of what is seen to the other, and Newton's method there.
/// @param t_end   where the ray leaves the scene
/// @param hidden  set if it leaves the pictures before
Met meetLayer(Ray ray, float t_end, Start start, Pictures pictures, usampler2DArray seen_layers, sampler2DArray surfaces, uint layer,
              uint iterations, inout bool hidden) {
  Met met = approach(ray, 0.0, start, pictures, seen_layers, surfaces, layer, iterations);
  if (met.instance != kNowhere) return met;
  Look before = lookAt(ray.origin, pictures, seen_layers, surfaces, layer);
  float t_before = 0.0;
  // A step more than to where the ray leaves the scene: what it meets there may bound the scene.
  for (uint i = 1u; i <= kSteps + 1u && met.instance == kNowhere; ++i) {
    float share_of_way = float(i) / float(kSteps), t = t_end * share_of_way * share_of_way;
    Look look = lookAt(ray.origin + t * ray.dir, pictures, seen_layers, surfaces, layer);
    bool crosses = before.shown && look.shown && (before.behind > 0.0) != (look.behind > 0.0);
    // Or it passes the outline of something round, which bends away there.
    if (crosses || before.shown != look.shown) {
      float share = crosses ? before.behind / (before.behind - look.behind) : before.shown ? 0.0 : 1.0;
      met = approach(ray, mix(t_before, t, share), start, pictures, seen_layers, surfaces, layer, iterations);
      // Past an edge nothing is met.
      if (met.t < t_before || met.t > t + max(look.texel_size, before.texel_size))
        met = Met(kFarAway, 0.0, 0.0, kNowhere, 0u);
    }
    if (!look.inside) {
      hidden = hidden || (i <= kSteps && met.instance == kNowhere);
      return met;
    }
    before = look;
    t_before = t;
  }
  return met;
}

/// The nearest over all layers.
Met meetLayers(Ray ray, float t_end, Start start, Pictures pictures, usampler2DArray seen_layers, sampler2DArray surfaces,
               uint iterations, inout bool hidden) {
  Met best = Met(kFarAway, 0.0, 0.0, kNowhere, 0u);
  for (uint layer = 0u; layer < pictures.layer_count; ++layer) {
    Met met = meetLayer(ray, t_end, start, pictures, seen_layers, surfaces, layer, iterations, hidden);
    if (met.t < best.t) best = met;
  }
  return best;
}

#endif
