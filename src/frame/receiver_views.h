// From where all receivers are seen that a caustic may reach: views along the axes.
#pragma once

#include <span>
#include <vector>

#include "frame/scene_buffers.h"

namespace nephroid {

/// Parallel views along the positive and negative axes, each for those sides of receivers that face it more than they
/// face other axes. Sides that no generator lies before are left out, and of closed meshes those inside: the last
/// stretch of every path of a caustic begins on a generator. All pictures are squares of one size about one place.
struct ReceiverViews {
  std::vector<ViewRecord> views;  ///< at most 6; none if nothing can catch a caustic
  std::uint32_t axes = 0;         ///< as frame/receiver_map.shared.h
  std::uint32_t views_by_axis = 0;
  vec3 centre{0.0F};  ///< of all their pictures
  float half = 0.0F;  ///< of a picture's side, m
};

/// @param draws  of the scene
ReceiverViews makeReceiverViews(const SceneData& scene, std::span<const SceneBuffers::Draw> draws);

}  // namespace nephroid
