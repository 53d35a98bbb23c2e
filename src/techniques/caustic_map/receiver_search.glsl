// Where a ray meets a receiver, by the methods that [shah-caustics-mapping] §III-C and D uses and compares: all of them
// know the receiver as a picture of places, and what they return is a place that the picture shows. They are for
// comparison; what is met is otherwise found by layered_view.glsl, exactly.
//
//   iterate  eqs. 1-3: the distance of the place that is looked up at the present estimate is the next estimate
//   newton   eqs. 4, 5 and the appendix: with f(d) the distance between the estimate and what is looked up there, and
//            its slope by a finite difference
//   secant   on the signed distance along the view, as distance impostors do
//   march    steps to where the ray passes from before the receiver to behind it, then halving
//
// The paper's first guess is 1, a length; without one it is the distance of what is looked up where the ray starts, so
// that the scene's size does not count. Where two estimates alternate, the first two methods halve the interval.
#ifndef NEPHROID_RECEIVER_SEARCH_GLSL
#define NEPHROID_RECEIVER_SEARCH_GLSL

#include "techniques/caustic_map/layered_view.glsl"

/// A step of bisection: which half the ray enters the receiver in.
struct Bracket {
  bool valid;
  float before;  // distances along the ray
  float behind;
};

/// Part of the first guess that the appendix's Newton starts with and takes for the difference.
const float kNewtonPart = 0.1;

/// What is seen at a distance along a ray.
Look lookAlong(Ray ray, float t, Pictures pictures, sampler2DArray surfaces, uint layer) {
  return lookAt(ray.origin + t * ray.dir, pictures, surfaces, layer);
}

float halve(inout Bracket bracket, float t, Look look) {
  if (look.behind > 0.0) bracket.behind = t;
  else bracket.before = t;
  return 0.5 * (bracket.before + bracket.behind);
}

/// The next estimate by one of the methods that keep a single one; nothing below 0.
float nextEstimate(Ray ray, float t, float delta, Look look, Pictures pictures, sampler2DArray surfaces, uint layer) {
  if (kSearch == kSearchIterate) return length(look.surface.xyz - ray.origin);
  Look ahead = lookAlong(ray, t + delta, pictures, surfaces, layer);
  if (!ahead.shown) return t;
  float f = length(look.surface.xyz - (ray.origin + t * ray.dir));
  float slope = (length(ahead.surface.xyz - (ray.origin + (t + delta) * ray.dir)) - f) / delta;
  return slope != 0.0 ? max(t - f / slope, 0.0) : t;
}

float searchByEstimates(Ray ray, float guess, Pictures pictures, sampler2DArray surfaces,
                        uint layer, uint iterations) {
  float delta = kNewtonPart * guess;
  float t = kSearch == kSearchNewton ? delta : guess, last = -1.0;
  Bracket bracket = Bracket(false, 0.0, 0.0);
  for (uint i = 0u; i < iterations; ++i) {
    Look look = lookAlong(ray, t, pictures, surfaces, layer);
    if (!look.shown) return t;
    float next = bracket.valid ? halve(bracket, t, look)
                               : nextEstimate(ray, t, delta, look, pictures, surfaces, layer);
    if (!bracket.valid && last >= 0.0 && abs(next - last) < 0.25 * abs(next - t)) {
      bracket = Bracket(true, min(t, next), max(t, next));
      next = 0.5 * (t + next);
    }
    last = t;
    t = next;
  }
  return t;
}

float searchBySecant(Ray ray, float guess, Pictures pictures, sampler2DArray surfaces, uint layer,
                     uint iterations) {
  float t = guess, last = 0.0;
  float f_last = lookAlong(ray, last, pictures, surfaces, layer).behind;
  for (uint i = 0u; i < iterations; ++i) {
    Look look = lookAlong(ray, t, pictures, surfaces, layer);
    if (!look.shown || look.behind == f_last) return t;
    float next = max(t - look.behind * (t - last) / (look.behind - f_last), 0.0);
    f_last = look.behind;
    last = t;
    t = next;
  }
  return t;
}

float searchByMarching(Ray ray, float t_end, Pictures pictures, sampler2DArray surfaces,
                       uint layer, uint iterations) {
  Bracket bracket = Bracket(false, 0.0, 0.0);
  for (uint i = 1u; i <= kSteps + 1u && !bracket.valid; ++i) {
    float t = t_end * float(i) / float(kSteps);
    Look look = lookAlong(ray, t, pictures, surfaces, layer);
    bracket.valid = look.shown && look.behind > 0.0;
    bracket.behind = t;
    bracket.before = bracket.valid ? bracket.before : t;
  }
  float t = 0.5 * (bracket.before + bracket.behind);
  for (uint i = 0u; i < iterations && bracket.valid; ++i)
    t = halve(bracket, t, lookAlong(ray, t, pictures, surfaces, layer));
  return t;
}

/// @param t_end  where the ray leaves the scene
/// @param guess  first distance, m; 0: what is looked up where the ray starts
/// @param place  set to what the picture shows
/// @return       its weights say nothing
Met searchReceiver(Ray ray, float t_end, float guess, Pictures pictures, usampler2DArray seen, sampler2DArray surfaces,
                   uint layer, uint iterations, out vec3 place) {
  Met none = Met(kFarAway, 0.0, 0.0, kNowhere, 0u);
  place = ray.origin;
  if (guess <= 0.0) {
    Look first = lookAlong(ray, 0.0, pictures, surfaces, layer);
    guess = first.shown ? length(first.surface.xyz - ray.origin) : t_end;
  }
  float t = 0.0;
  if (kSearch == kSearchMarch)
    t = searchByMarching(ray, t_end, pictures, surfaces, layer, iterations);
  else if (kSearch == kSearchSecant)
    t = searchBySecant(ray, guess, pictures, surfaces, layer, iterations);
  else
    t = searchByEstimates(ray, guess, pictures, surfaces, layer, iterations);
  Look found = lookAlong(ray, t, pictures, surfaces, layer);
  if (!found.shown) return none;
  place = found.surface.xyz;
  uvec2 shows = texelFetch(seen, found.texel, 0).xy;
  return Met(length(place - ray.origin), 1.0 / 3.0, 1.0 / 3.0, shows.x - 1u, shows.y);
}

/// Where light that has entered a solid meets its back face ([wyman-2005]): a distance between that along the light and
/// that along the normal, by the angles of incidence and refraction, and what the picture of what lies behind shows there.
/// @param normal  of the front face, out of the solid
/// @param from    travel of the light outside
Met meetBackFace(Ray ray, vec3 normal, vec3 from, Pictures pictures, usampler2DArray seen, sampler2DArray surfaces) {
  Met none = Met(kFarAway, 0.0, 0.0, kNowhere, 0u);
  Look along = lookAt(ray.origin, pictures, surfaces, 1u);
  if (!along.shown) return none;
  float depth = length(along.surface.xyz - ray.origin);
  Look across = lookAt(ray.origin - depth * normal, pictures, surfaces, 1u);
  float thickness = across.shown ? length(across.surface.xyz - ray.origin) : depth;
  float incident = acos(clamp(-dot(from, normal), 0.0, 1.0)), refracted = acos(clamp(-dot(ray.dir, normal), 0.0, 1.0));
  float share = incident > 1e-4 ? refracted / incident : 1.0;
  Look back = lookAt(ray.origin + mix(thickness, depth, share) * ray.dir, pictures, surfaces, 1u);
  if (!back.shown) return none;
  uvec2 shows = texelFetch(seen, back.texel, 0).xy;
  InstanceRecord instance = fetchInstance(shows.x - 1u);
  Triangle corners = toWorld(instance, fetchTriangle(instance.first_triangle + shows.y));
  vec3 out_of = unpackUnitVector(floatBitsToUint(back.surface.w));
  RayTriangle hit = intersectPlaneOf(corners, back.surface.xyz + back.texel_size * out_of, -out_of);
  if (hit.size <= 0.0) return none;
  return Met(length(back.surface.xyz - ray.origin), hit.u / hit.size, hit.v / hit.size, shows.x - 1u, shows.y);
}

#endif
