// What `nephroid info` knows about a scene: geometry, materials, who casts and who receives, and why not.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/classify.h"
#include "scene/scene_data.h"

namespace nephroid {

/// How one placed mesh looks to light transport.
struct InstanceReport {
  std::string name, material;
  std::size_t triangle_count = 0;
  std::size_t open_edge_count = 0;          ///< edges with one triangle, after welding equal positions
  std::size_t nonmanifold_edge_count = 0;   ///< edges with more than two
  std::size_t inconsistent_edge_count = 0;  ///< neighbours that wind in opposite senses
  std::size_t degenerate_count = 0;         ///< triangles without area
  std::size_t flipped_normal_count = 0;     ///< triangles whose vertex normals point against their winding
  bool inward = false;                      ///< closed, and its signed volume is negative: normals point inward
  double signed_volume = 0;                 ///< m³, world
  Bounds bounds;
  Classification classification;
};

struct SceneReport {
  std::vector<InstanceReport> instances;
  std::vector<std::string> warnings;   ///< the scene's own and those that follow from the geometry
  std::vector<std::string> diagnosis;  ///< why something will cast no caustic: no generator, no receiver, no light, …
};

SceneReport inspectScene(const SceneData& scene, float specular_alpha = kDefaultSpecularAlpha);

/// As text for people, and as JSON.
std::string formatReport(const SceneData& scene, const SceneReport& report);
std::string formatReportJson(const SceneData& scene, const SceneReport& report);

}  // namespace nephroid
