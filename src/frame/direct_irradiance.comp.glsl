// Irradiance of the light that comes straight from the lights, and its direction, added by pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#define NEPHROID_LIGHT_BINDINGS 7
#include "frame/lights.glsl"
#define NEPHROID_PIXEL_BINDINGS 11
#include "frame/pixel_surface.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 16, rgba32f) uniform image2D irradiance_image;  // W/m²
layout(set = 0, binding = 17, rgba32f) uniform image2D direction_image;

layout(push_constant, scalar) uniform Push {
  uint light_count;
  float weight;
};

float luminanceOf(vec3 rgb) { return dot(rgb, vec3(0.2126, 0.7152, 0.0722)); }

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(irradiance_image);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  PixelSurface s;
  if (!surfaceOfPixel(pixel, size, s)) return;
  Place place = Place(s.position + s.position_error * s.geometric, s.instance, s.triangle);
  vec3 irradiance = vec3(0.0);
  vec4 direction = vec4(0.0);
  for (uint i = 0u; i < light_count; ++i) {
    LightRecord light = fetchLight(i);
    if (light.view_count == 0u) continue;
    Arriving arriving = arriveFrom(light, s.position);
    float cos_light = dot(arriving.dir, s.shading);
    if (cos_light <= 0.0 || dot(arriving.dir, s.geometric) <= 0.0) continue;
    vec3 of_light = weight * cos_light * arriving.irradiance * visibilityOf(i, light, place, arriving, s.position);
    irradiance += of_light;
    direction += luminanceOf(of_light) * vec4(-arriving.dir, 1.0);
  }
  imageStore(irradiance_image, pixel, imageLoad(irradiance_image, pixel) + vec4(irradiance, 0.0));
  imageStore(direction_image, pixel, imageLoad(direction_image, pixel) + direction);
}
