// Views of the scene: the camera's, and those of a light.
#pragma once

#include "frame/frame.shared.h"
#include "scene/scene_data.h"

namespace nephroid {

/// Distances between which a view shows things, m.
struct DepthRange {
  float near = 0.0F, far = 1.0F;
};

/// The range that holds `bounds` as seen from `eye` along `forward`; near is a small part of far where the eye is
/// inside.
DepthRange fitDepthRange(const Bounds& bounds, vec3 eye, vec3 forward);

/// @param film_offset  of the sample in its pixel, in [0, 1)², (0.5, 0.5) the centre: what is drawn is shifted by it
ViewRecord makeCameraView(const Camera& camera, int width, int height, const Bounds& bounds, vec2 film_offset);

/// @param half_tangents  of half the angles of view, across and along `up`
ViewRecord makePerspectiveView(vec3 eye, vec3 forward, vec3 up, vec2 half_tangents, const DepthRange& range);

/// One of six views along +x, −x, +y, −y, +z, −z.
ViewRecord makeCubeView(vec3 eye, int face, const Bounds& bounds);

/// Parallel rays along `direction` that cover `bounds`.
ViewRecord makeParallelView(vec3 direction, const Bounds& bounds);
/// Likewise, as wide as `sides` and as deep as `along`.
/// @param frame  its z is the direction
/// @param sides  in that frame; their z does not count
ViewRecord makeParallelView(const Frame& frame, const Bounds& sides, const Bounds& along);

/// Likewise of a picture about `centre`, from before `along` to behind it.
/// @param right, up  half its width and height, across the direction
ViewRecord makeParallelView(vec3 direction, vec3 right, vec3 up, vec3 centre, const Bounds& along);

/// False only if nothing inside `bounds` can be seen.
bool mayShow(const ViewRecord& view, const Bounds& bounds);

}  // namespace nephroid
