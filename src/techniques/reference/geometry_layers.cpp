#include "techniques/reference/geometry_layers.h"

#include <array>

#include "core/parallel.h"

namespace nephroid {
namespace {

/// What the eye finds in one pixel.
struct Seen {
  vec3 albedo{0.0F}, normal{0.0F}, position{0.0F};
  float depth = kInfinity, id = 0.0F;
};

Seen look(const ReferenceWorld& world, int x, int y) {
  Seen seen;
  Ray ray = world.camera_model.rayThrough(vec2(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F));
  SurfaceMaterial scratch;
  RayHit hit;
  // As many holes as a walk allows.
  for (int step = 0; step < 256 && world.scene.intersect(ray, hit); ++step) {
    const SurfacePoint point = world.scene.surfaceAt(ray, hit);
    const SurfaceMaterial& material = world.materials.at(point, scratch);
    if (material.coverage >= 0.5F) {
      seen.albedo = material.base;
      seen.normal = dot(point.normal_geometric, ray.dir) < 0.0F ? point.normal_shading : -point.normal_shading;
      seen.position = point.position;
      seen.depth = world.camera_model.depthOf(point.position);
      seen.id = static_cast<float>(hit.instance + 1);
      break;
    }
    ray.origin = offsetOrigin(point, ray.dir);
  }
  return seen;
}

}  // namespace

std::vector<Layer> renderGeometryLayers(const ReferenceWorld& world, const std::vector<std::string>& names) {
  struct Kind {
    std::string_view name;
    int channels;
    vec3 (*value)(const Seen&);
  };
  static constexpr std::array<Kind, 5> kKinds{{{"albedo", 3, [](const Seen& s) { return s.albedo; }},
                                               {"normal", 3, [](const Seen& s) { return s.normal; }},
                                               {"position", 3, [](const Seen& s) { return s.position; }},
                                               {"depth", 1, [](const Seen& s) { return vec3(s.depth); }},
                                               {"id", 1, [](const Seen& s) { return vec3(s.id); }}}};
  const int width = world.camera_model.width(), height = world.camera_model.height();
  std::vector<Layer> layers;
  std::vector<const Kind*> kinds;
  for (const std::string& name : names)
    for (const Kind& kind : kKinds)
      if (kind.name == name) {
        layers.push_back({name, Image(width, height, kind.channels)});
        kinds.push_back(&kind);
      }
  if (layers.empty()) return layers;
  parallelFor(static_cast<std::size_t>(height), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      const Seen seen = look(world, x, y);
      for (std::size_t k = 0; k < layers.size(); ++k) {
        const vec3 value = kinds[k]->value(seen);
        for (int c = 0; c < kinds[k]->channels; ++c) layers[k].image.at(x, y)[c] = value[c];
      }
    }
  });
  return layers;
}

}  // namespace nephroid
