// The scene's tables, read texel by texel. Bindings 0 to 6 of set 0.
#ifndef NEPHROID_TABLES_GLSL
#define NEPHROID_TABLES_GLSL

#include "frame/frame.shared.h"
#include "core/optics/photon.shared.h"

layout(set = 0, binding = 0) uniform usamplerBuffer triangle_table;
layout(set = 0, binding = 1) uniform usamplerBuffer instance_table;
layout(set = 0, binding = 2) uniform usamplerBuffer material_table;
layout(set = 0, binding = 3) uniform usamplerBuffer attribute_table;
layout(set = 0, binding = 4) uniform usamplerBuffer texture_table;
layout(set = 0, binding = 5) uniform samplerBuffer byte_texels;
layout(set = 0, binding = 6) uniform samplerBuffer float_texels;

// What no material of the scene has is not compiled: a device that runs all branches for all threads pays for each.
layout(constant_id = 0) const bool kSceneHasMetal = true;
layout(constant_id = 1) const bool kSceneHasGloss = true;
layout(constant_id = 2) const bool kSceneHasConductors = true;
layout(constant_id = 3) const bool kSceneHasTextures = true;   // or colours of vertices
layout(constant_id = 4) const bool kSceneHasPassable = true;   // panes, cut-outs

InstanceRecord fetchInstance(uint i) {
  InstanceRecord r;
  r.row_x = uintBitsToFloat(texelFetch(instance_table, int(5u * i)));
  r.row_y = uintBitsToFloat(texelFetch(instance_table, int(5u * i + 1u)));
  r.row_z = uintBitsToFloat(texelFetch(instance_table, int(5u * i + 2u)));
  uvec4 w = texelFetch(instance_table, int(5u * i + 3u));
  r.first_triangle = w.x;
  r.material = w.y;
  r.flags = w.z;
  r.solid = w.w;
  uvec4 attributes = uvec4(kNowhere);
  if (kSceneHasTextures) attributes = texelFetch(instance_table, int(5u * i + 4u));
  r.texcoords_0 = attributes.x;
  r.texcoords_1 = attributes.y;
  r.colors = attributes.z;
  r.tangents = attributes.w;
  return r;
}

/// @param i  of all triangles of all meshes
TriangleRecord fetchTriangle(uint i) {
  uvec4 a = texelFetch(triangle_table, int(3u * i));
  uvec4 b = texelFetch(triangle_table, int(3u * i + 1u));
  uvec4 c = texelFetch(triangle_table, int(3u * i + 2u));
  return TriangleRecord(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz), c.w);
}

MaterialRecord fetchMaterial(uint i) {
  MaterialRecord m;
  m.base = uintBitsToFloat(texelFetch(material_table, int(9u * i)));
  vec4 emission = uintBitsToFloat(texelFetch(material_table, int(9u * i + 1u)));
  m.emission = emission.xyz;
  m.metallic = emission.w;
  vec4 tint = uintBitsToFloat(texelFetch(material_table, int(9u * i + 2u)));
  m.specular_tint = tint.xyz;
  m.roughness = tint.w;
  uvec4 transmission = texelFetch(material_table, int(9u * i + 3u));
  m.transmission = uintBitsToFloat(transmission.x);
  m.ior = uintBitsToFloat(transmission.y);
  m.average_fresnel = uintBitsToFloat(transmission.z);
  m.flags = transmission.w;
  vec4 ior = vec4(0.0), k = vec4(0.0);
  if (kSceneHasConductors || kSceneHasPassable) ior = uintBitsToFloat(texelFetch(material_table, int(9u * i + 4u)));
  if (kSceneHasConductors || kSceneHasTextures) k = uintBitsToFloat(texelFetch(material_table, int(9u * i + 5u)));
  m.conductor_ior = ior.xyz;
  m.alpha_cutoff = ior.w;
  m.conductor_k = k.xyz;
  m.normal_scale = k.w;
  uvec4 first = uvec4(kNowhere), second = uvec4(kNowhere);
  if (kSceneHasTextures) {
    first = texelFetch(material_table, int(9u * i + 6u));
    second = texelFetch(material_table, int(9u * i + 7u));
  }
  m.base_texture = first.x;
  m.metallic_roughness_texture = first.y;
  m.normal_texture = first.z;
  m.emission_texture = first.w;
  m.transmission_texture = second.x;
  m.specular_texture = second.y;
  m.specular_color_texture = second.z;
  // What fills it is asked for by fetchMedium.
  m.priority = 0;
  m.sigma_a = vec3(0.0);
  m.dispersion = 0.0;
  return m;
}

/// What a solid of a material is filled with.
struct Medium {
  float ior;
  float dispersion;
  vec3 sigma_a;  // 1/m
  int priority;
};

/// @param material  kNowhere: vacuum
Medium fetchMedium(uint material) {
  if (material == kNowhere) return Medium(1.0, 0.0, vec3(0.0), 0);
  vec4 absorbs = uintBitsToFloat(texelFetch(material_table, int(9u * material + 8u)));
  return Medium(uintBitsToFloat(texelFetch(material_table, int(9u * material + 3u)).y), absorbs.w, absorbs.xyz,
                int(texelFetch(material_table, int(9u * material + 7u)).w));
}

TextureRecord fetchTexture(uint i) {
  TextureRecord t;
  uvec4 w = texelFetch(texture_table, int(3u * i));
  t.first_texel = w.x;
  t.width = w.y;
  t.height = w.z;
  t.flags = w.w;
  t.row_u = uintBitsToFloat(texelFetch(texture_table, int(3u * i + 1u)).xyz);
  t.row_v = uintBitsToFloat(texelFetch(texture_table, int(3u * i + 2u)).xyz);
  return t;
}

/// Attribute texel, as floats.
vec4 fetchAttribute(uint i) { return uintBitsToFloat(texelFetch(attribute_table, int(i))); }

#endif
