// One of the layers that show geometry, from the g-buffer.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/scene_access.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 5) readonly buffer Views { ViewRecord views[]; };
layout(set = 0, binding = 6, rgba32f) readonly uniform image2D position_image;
layout(set = 0, binding = 7, rgba32ui) readonly uniform uimage2D surface_image;
layout(set = 0, binding = 8, rgba32f) writeonly uniform image2D layer_image;

layout(push_constant, scalar) uniform Push { uint kind; };  // 0 albedo, 1 normal, 2 position, 3 depth, 4 id

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(position_image);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  ViewRecord view = views[0];
  uvec4 surface = imageLoad(surface_image, pixel);
  vec3 position = imageLoad(position_image, pixel).xyz;
  vec3 value = vec3(0.0);
  if (surface.x == 0u) {
    // Depth of nothing is infinite; 1/0 is undefined in shaders, the bits are not.
    if (kind == 3u) value = vec3(uintBitsToFloat(0x7F800000u));
  } else if (kind == 0u) {
    value = materials[instances[surface.x - 1u].material].base;
  } else if (kind == 1u) {
    vec3 shading = unpackUnit(surface.w);
    value = dot(dirToEye(view, position), unpackUnit(surface.z)) > 0.0 ? shading : -shading;
  } else if (kind == 2u) {
    value = position;
  } else if (kind == 3u) {
    value = vec3(dot(position - view.eye, view.forward));
  } else {
    value = vec3(float(surface.x));
  }
  imageStore(layer_image, pixel, vec4(value, 1.0));
}
