#include "scene/fingerprint.h"

#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/content_hash.h"

namespace nephroid {
namespace {

/// Numbers and vectors of them: every bit counts.
template <class T>
inline constexpr bool kIsPlain = std::is_arithmetic_v<T>;
template <int N, class T>
inline constexpr bool kIsPlain<glm::vec<N, T>> = sizeof(glm::vec<N, T>) == N * sizeof(T);

/// Feeds values of every type that a scene is made of into one hash. Structures are taken apart by structured bindings:
/// one that gains a field no longer compiles here until it is said what becomes of it.
class SceneHash {
 public:
  std::uint64_t digest() const { return hash_.digest(); }

  template <class... Values>
  void addAll(const Values&... values) {
    (add(values), ...);
  }

  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void add(T value) { hash_.add(value); }
  void add(const std::string& text) { hash_.add(std::string_view(text)); }
  template <int N>
  void add(const glm::vec<N, float>& v) {
    for (int i = 0; i < N; ++i) hash_.add(v[i]);
  }
  template <int C, int R>
  void add(const glm::mat<C, R, float>& m) {
    for (int i = 0; i < C; ++i) add(m[i]);
  }
  /// What has no gaps is one run of bytes.
  template <class T>
  void add(const std::vector<T>& values) {
    if constexpr (kIsPlain<T>) {
      hash_.add(std::as_bytes(std::span(values)));
    } else {
      hash_.add(values.size());
      for (const T& value : values) add(value);
    }
  }
  template <class T>
  void add(const std::optional<T>& value) {
    hash_.add(value.has_value());
    if (value) add(*value);
  }

  void add(const ByteImage& image) {
    const auto& [width, height, pixels] = image;
    addAll(width, height, pixels);
  }
  void add(const Image& image) {
    const auto& [width, height, channels, pixels] = image;
    addAll(width, height, channels, pixels);
  }
  void add(const TextureImage& texture) {
    const auto& [name, image] = texture;
    hash_.add(image.index());
    std::visit([&](const auto& held) { add(held); }, image);
  }
  void add(const TextureRef& reference) {
    const auto& [image, texcoord, wrap_u, wrap_v, nearest, uv_from_texcoord] = reference;
    addAll(image, texcoord, wrap_u, wrap_v, nearest, uv_from_texcoord);
  }
  void add(const Material& material);
  void add(const Mesh& mesh) {
    const auto& [name, positions, normals, tangents, texcoords, colors, triangles, material] = mesh;
    addAll(positions, normals, tangents, texcoords[0], texcoords[1], colors, triangles, material);
  }
  void add(const Instance& instance) {
    const auto& [name, mesh, world_from_object, object, casts] = instance;
    addAll(mesh, world_from_object, object, casts);
  }
  void add(const Light& light) {
    const auto& [name, kind, position, direction, intensity, radius, angle_deg, inner_cone, outer_cone] = light;
    addAll(kind, position, direction, intensity, radius, angle_deg, inner_cone, outer_cone);
  }
  void add(const Environment& environment) {
    const auto& [radiance, rotation_deg, scale, source] = environment;
    addAll(*radiance, rotation_deg, scale);
  }
  void add(const Camera& camera) {
    const auto& [name, eye, forward, up, fov_y, ortho_height] = camera;
    addAll(eye, forward, up, fov_y, ortho_height);
  }

 private:
  ContentHash hash_;
};

void SceneHash::add(const Material& material) {
  const auto& [name, base_color, metallic, roughness, emission, transmission, ior, dispersion, thickness,
               attenuation_color, attenuation_distance, specular_factor, specular_color, conductor_ior, conductor_k,
               normal_scale, double_sided, alpha_mode, alpha_cutoff, priority, base_color_texture,
               metallic_roughness_texture, normal_texture, emission_texture, transmission_texture, specular_texture,
               specular_color_texture] = material;
  addAll(base_color, metallic, roughness, emission, transmission, ior, dispersion, thickness, attenuation_color,
         attenuation_distance, specular_factor, specular_color, conductor_ior, conductor_k, normal_scale, double_sided,
         alpha_mode, alpha_cutoff, priority, base_color_texture, metallic_roughness_texture, normal_texture,
         emission_texture, transmission_texture, specular_texture, specular_color_texture);
}

}  // namespace

std::uint64_t fingerprintScene(const SceneData& scene) {
  const auto& [name, images, materials, meshes, instances, lights, environment, cameras, warnings, duration] = scene;
  SceneHash hash;
  hash.addAll(images, materials, meshes, instances, lights, environment);
  return hash.digest();
}

std::uint64_t fingerprintCamera(const Camera& camera) {
  SceneHash hash;
  hash.add(camera);
  return hash.digest();
}

}  // namespace nephroid
