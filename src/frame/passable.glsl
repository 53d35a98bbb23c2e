// Surfaces that light and sight may pass straight through: panes, holes of masks, surfaces that are partly there.
//
// Each pixel of each frame decides by chance what it shows of a surface that is both there and not: the mean over frames
// is the sum of both. What only lets pass (a clear pane) is never shown, and what it takes from the light behind is
// multiplied into the image of tints, in any order.
#ifndef NEPHROID_PASSABLE_GLSL
#define NEPHROID_PASSABLE_GLSL

#include "frame/material.glsl"

/// A number in [0, 1) that depends on all of them.
float chanceOf(uvec2 pixel, uint frame, Surface s, uint which) {
  uint h = hashChain(hashChain(pixel.x + (pixel.y << 16), frame), which);
  return float(hashChain(hashChain(h, s.instance_index), s.triangle) >> 8) / 16777216.0;
}

/// What a pixel does with a surface.
struct Passage {
  bool shown;
  float weight;  // of what it shows
  vec3 tint;     // of what is seen through it, if it is not shown
};

/// Chance with which a pane is looked through: always if it has nothing of its own to show.
float chanceToPass(MaterialPoint m) {
  float own = (1.0 - m.optics.metallic) * (1.0 - m.optics.transmission) + m.optics.metallic;
  bool emits = max(m.emission.x, max(m.emission.y, m.emission.z)) > 0.0;
  return own > 0.0 || emits ? clamp(1.0 - own, 0.25, 0.75) : 1.0;
}

Passage passageAt(Surface s, MaterialPoint m, vec3 dir, uvec2 pixel, uint frame) {
  Passage p = Passage(true, 1.0, vec3(1.0));
  if (m.coverage < 1.0 && chanceOf(pixel, frame, s, 0u) >= m.coverage) {
    p.shown = false;
    return p;
  }
  if (m.optics.is_pane == 0u || m.optics.alpha != 0.0) return p;
  float chance = chanceToPass(m);
  p.shown = chanceOf(pixel, frame, s, 1u) >= chance;
  p.weight = p.shown ? 1.0 / (1.0 - chance) : 1.0;
  MaterialPoint whole = m;
  whole.coverage = 1.0;
  p.tint = passTransmittance(whole, abs(dot(dir, s.shading))) / chance;
  return p;
}

#endif
