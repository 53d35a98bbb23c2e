#include "scene/edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "nephroid/error.h"
#include "scene/edit_text.h"

namespace nephroid {
namespace {

constexpr double kHuge = 1e9;  // bound of lengths in an edit: beyond it single precision is of no use

std::vector<ParamSpec> materialSpecs() {
  return {
      {"ior", 1.5F, 0.1, 100.0, "", "index of refraction", {}},
      {"transmission", 0.0F, 0.0, 1.0, "", "share that transmits", {}},
      {"thickness", 0.0F, 0.0, kHuge, "m", "0 is thin-walled, anything else solid", {}},
      {"roughness", 1.0F, 0.0, 1.0, "", "microfacet alpha is its square", {}},
      {"metallic", 0.0F, 0.0, 1.0, "", "share that is metal", {}},
      {"baseColor", vec3(1), 0.0, 1.0, "", "linear RGB", {}},
      {"abbe", 0.0F, 0.0, 1000.0, "", "Abbe number; 0: no dispersion", {}},
      {"dispersion", 0.0F, 0.0, 20.0, "", "20 / Abbe number", {}},
      {"attenuation", vec3(1), 0.0, 1.0, "", "what white becomes after attenuationDistance inside", {}},
      {"attenuationDistance", 0.0F, 1e-9, kHuge, "m", "path to which attenuation refers", {}},
      {"emission", vec3(0), 0.0, 1e12, "W/m^2/sr", "radiance", {}},
      {"specular", 1.0F, 0.0, 1.0, "", "scales the reflection of a dielectric", {}},
      {"priority", 0, -1000.0, 1000.0, "", "which solid wins where two overlap", {}},
      {"eta", vec3(1), 0.0, 100.0, "", "real part of a metal's index, RGB", {}},
      {"k", vec3(0), 0.0, 100.0, "", "imaginary part of a metal's index, RGB", {}},
  };
}

void checkMaterialEdit(const ParamSet& p, std::string_view edit) {
  if (p.isSet("abbe") && p.isSet("dispersion"))
    throw UsageError(fmt::format("--material {}: abbe and dispersion say the same thing; give only one of them", edit));
  if (p.isSet("k") && !p.isSet("eta"))
    throw UsageError(fmt::format("--material {}: k needs eta, the other part of the metal's index", edit));
}

void editMaterial(Material& m, const ParamSet& p, std::vector<std::string>& warnings) {
  const auto take = [&](const char* key, float& field) {
    if (p.isSet(key)) field = p.getFloat(key);
  };
  take("ior", m.ior);
  take("transmission", m.transmission);
  take("thickness", m.thickness);
  take("roughness", m.roughness);
  take("metallic", m.metallic);
  take("dispersion", m.dispersion);
  take("attenuationDistance", m.attenuation_distance);
  take("specular", m.specular_factor);
  if (p.isSet("abbe")) m.dispersion = p.getFloat("abbe") > 0.0F ? 20.0F / p.getFloat("abbe") : 0.0F;
  if (p.isSet("baseColor")) m.base_color = vec4(p.getVec3("baseColor"), m.base_color.w);
  if (p.isSet("attenuation")) m.attenuation_color = p.getVec3("attenuation");
  if (p.isSet("emission")) m.emission = p.getVec3("emission");
  if (p.isSet("priority")) m.priority = p.getInt("priority");
  if (p.isSet("eta")) m.conductor_ior = p.getVec3("eta");
  if (p.isSet("k")) m.conductor_k = p.getVec3("k");
  if (p.isSet("attenuation") && m.attenuation_color != vec3(1) && std::isinf(m.attenuation_distance))
    warnings.push_back(fmt::format("material '{}': attenuation has no effect without attenuationDistance", m.name));
}

/// Gives instance `index` a mesh and a material that nobody else uses; instances in `alike` may share the mesh.
void separateMaterial(SceneData& scene, const std::set<std::size_t>& alike) {
  std::vector<std::uint32_t> copied(scene.meshes.size(), kNone);
  std::vector<std::uint32_t> copied_material(scene.materials.size(), kNone);
  for (const std::size_t index : alike) {
    const std::uint32_t mesh = scene.instances[index].mesh, material = scene.meshes[mesh].material;
    if (copied_material[material] == kNone) {
      copied_material[material] = static_cast<std::uint32_t>(scene.materials.size());
      Material copy = scene.materials[material];
      copy.name = fmt::format("{} of {}", copy.name, scene.instances[index].name);
      scene.materials.push_back(std::move(copy));
    }
    if (copied[mesh] == kNone) {
      bool shared = false;
      for (std::size_t i = 0; i < scene.instances.size(); ++i)
        shared = shared || (scene.instances[i].mesh == mesh && !alike.contains(i));
      copied[mesh] = mesh;
      if (shared) {
        copied[mesh] = static_cast<std::uint32_t>(scene.meshes.size());
        Mesh copy = scene.meshes[mesh];
        scene.meshes.push_back(std::move(copy));
      }
      scene.meshes[copied[mesh]].material = copied_material[material];
    }
    scene.instances[index].mesh = copied[mesh];
  }
}

}  // namespace

void applyMaterialEdit(SceneData& scene, std::string_view edit) {
  const auto [pattern, values] = splitEdit(edit, "--material");
  const ParamSet params = parseEditValues(materialSpecs(), "--material", edit, values);
  checkMaterialEdit(params, edit);
  bool found = false;
  for (Material& material : scene.materials)
    if (matchesGlob(pattern, material.name)) {
      editMaterial(material, params, scene.warnings);
      found = true;
    }
  if (found) return;
  std::set<std::size_t> nodes;
  for (std::size_t i = 0; i < scene.instances.size(); ++i)
    if (matchesGlob(pattern, scene.instances[i].name)) nodes.insert(i);
  if (nodes.empty())
    throw UsageError(fmt::format("--material {}: nothing is named '{}'; materials: {}; nodes: {}", edit, pattern,
                                 listNames(scene.materials), listNames(scene.instances)));
  separateMaterial(scene, nodes);
  std::set<std::uint32_t> materials;
  for (const std::size_t node : nodes) materials.insert(scene.meshes[scene.instances[node].mesh].material);
  for (const std::uint32_t material : materials) editMaterial(scene.materials[material], params, scene.warnings);
}

}  // namespace nephroid
