// `emission` of each pixel: what the surface there radiates, or the environment where there is none.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/scene_access.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 5) readonly buffer Views { ViewRecord views[]; };
layout(set = 0, binding = 6) uniform sampler2D environment;
layout(set = 0, binding = 7, rgba32f) readonly uniform image2D position_image;
layout(set = 0, binding = 8, rgba32ui) readonly uniform uimage2D surface_image;
layout(set = 0, binding = 9, rgba32f) uniform image2D emission_image;  // sum over samples, W/m²/sr

layout(push_constant, scalar) uniform Push {
  vec2 film_offset;
  float environment_scale;  // 0: there is none
  float cos_rotation;
  float sin_rotation;
};

const float kPi = 3.14159265358979;

vec3 environmentFrom(vec3 dir) {
  if (environment_scale == 0.0) return vec3(0.0);
  float x = dir.x * cos_rotation - dir.z * sin_rotation;
  float z = dir.x * sin_rotation + dir.z * cos_rotation;
  float u = x == 0.0 && z == 0.0 ? 0.5 : 0.5 + atan(x, -z) * (0.5 / kPi);
  float v = acos(clamp(dir.y, -1.0, 1.0)) / kPi;
  return environment_scale * textureLod(environment, vec2(u, v), 0.0).xyz;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(position_image);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  ViewRecord view = views[0];
  uvec4 surface = imageLoad(surface_image, pixel);
  vec3 radiance = vec3(0.0);
  if (surface.x == 0u) {
    radiance = environmentFrom(rayThrough(view, (vec2(pixel) + film_offset) / vec2(size) * 2.0 - 1.0).dir);
  } else {
    MaterialRecord material = materials[instances[surface.x - 1u].material];
    vec3 position = imageLoad(position_image, pixel).xyz;
    bool front = dot(dirToEye(view, position), unpackUnit(surface.z)) > 0.0;
    if (front || (material.flags & kMaterialDoubleSided) != 0u) radiance = material.emission;
  }
  if (radiance == vec3(0.0)) return;
  imageStore(emission_image, pixel, imageLoad(emission_image, pixel) + vec4(radiance, 0.0));
}
