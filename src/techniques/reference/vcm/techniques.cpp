#include "techniques/reference/vcm/techniques.h"

#include <algorithm>
#include <numeric>

namespace nephroid {
namespace {

/// A smooth factor is smooth whatever its texture says, which only scales it.
bool mayBeRough(const Material& material) { return material.roughness > 0.0F; }

}  // namespace

VcmTechniques::VcmTechniques(const ReferenceWorld& world, std::span<const std::unique_ptr<Emitter>> emitters,
                             std::span<const std::uint32_t> shares, const std::vector<bool>& is_target)
    : world_(world),
      sources_(world.lights.sourceCount()),
      is_target_(is_target),
      photons_(static_cast<float>(std::accumulate(shares.begin(), shares.end(), std::uint64_t{0}))) {
  for (std::size_t e = 0; e < emitters.size(); ++e)
    sources_[emitters[e]->source()] = {emitters[e].get(), static_cast<float>(shares[e]) / photons_};
  const SceneData& scene = world.scene.scene();
  const std::vector<Classification> classes = classifyMaterials(scene, world.options.specular_alpha);
  connects_ = std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    const std::uint32_t m = scene.meshes[instance.mesh].material;
    return (classes[m].is_generator || classes[m].is_weak_generator) && mayBeRough(scene.materials[m]);
  });
}

}  // namespace nephroid
