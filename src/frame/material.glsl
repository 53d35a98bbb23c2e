// A material at a point of a surface: textures and colours of vertices looked up as the reference does
// (scene/texture.cpp, trace/surface_material.cpp), so that both show the same.
#ifndef NEPHROID_MATERIAL_GLSL
#define NEPHROID_MATERIAL_GLSL

#include "frame/surface.glsl"
#include "core/optics/surface.shared.h"

float linearFromSrgb(float s) { return s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4); }

int wrapTexel(int i, int size, uint mode) {
  if (mode == 1u) return clamp(i, 0, size - 1);
  int period = mode == 2u ? 2 * size : size;
  int m = i % period;
  m += m < 0 ? period : 0;
  return m < size ? m : period - 1 - m;
}

vec4 fetchTexel(TextureRecord t, int x, int y, bool srgb) {
  x = wrapTexel(x, int(t.width), (t.flags >> kTextureWrapU) & 3u);
  y = wrapTexel(y, int(t.height), (t.flags >> kTextureWrapV) & 3u);
  int place = int(t.first_texel + uint(y) * t.width + uint(x));
  if ((t.flags & kTextureIsFloat) != 0u) return texelFetch(float_texels, place);
  vec4 raw = texelFetch(byte_texels, place);
  if (!srgb) return raw;
  return vec4(linearFromSrgb(raw.x), linearFromSrgb(raw.y), linearFromSrgb(raw.z), raw.w);
}

/// At its finest level, bilinear. One frame is one sample of each pixel; the mean of many is filtered.
/// @param srgb  decode bytes of RGB from sRGB
vec4 sampleTexture(TextureRecord t, vec2 texcoord, bool srgb) {
  vec2 uv = vec2(dot(t.row_u, vec3(texcoord, 1.0)), dot(t.row_v, vec3(texcoord, 1.0)));
  // Coordinates beyond a million periods carry no position any more, and must not overflow the integer texel index.
  if (!(abs(uv.x) < 1e6)) uv.x = 0.0;
  if (!(abs(uv.y) < 1e6)) uv.y = 0.0;
  if (((t.flags >> kTextureWrapU) & 3u) == 0u) uv.x -= floor(uv.x);
  if (((t.flags >> kTextureWrapV) & 3u) == 0u) uv.y -= floor(uv.y);
  vec2 place = uv * vec2(t.width, t.height);
  bool nearest = (t.flags & kTextureIsNearest) != 0u;
  vec2 corner = nearest ? floor(place) : floor(place - 0.5);
  int i = int(corner.x), j = int(corner.y);
  vec4 first = fetchTexel(t, i, j, srgb);
  if (nearest) return first;
  vec2 f = place - 0.5 - corner;
  return (1.0 - f.y) * ((1.0 - f.x) * first + f.x * fetchTexel(t, i + 1, j, srgb)) +
         f.y * ((1.0 - f.x) * fetchTexel(t, i, j + 1, srgb) + f.x * fetchTexel(t, i + 1, j + 1, srgb));
}

/// What textures need to know of a point.
struct Coordinates {
  vec2 sets[2];
  vec4 color;  // of the vertices
};

vec2 texcoordsOf(uint first, uint triangle, float u, float v) {
  if (first == kNowhere) return vec2(0.0);
  vec4 ab = fetchAttribute(first + 2u * triangle), c = fetchAttribute(first + 2u * triangle + 1u);
  return (1.0 - u - v) * ab.xy + u * ab.zw + v * c.xy;
}

Coordinates coordinatesAt(InstanceRecord instance, uint triangle, float u, float v) {
  Coordinates c;
  c.sets[0] = texcoordsOf(instance.texcoords_0, triangle, u, v);
  c.sets[1] = texcoordsOf(instance.texcoords_1, triangle, u, v);
  c.color = vec4(1.0);
  if (instance.colors != kNowhere) {
    uint first = instance.colors + 3u * triangle;
    c.color = (1.0 - u - v) * fetchAttribute(first) + u * fetchAttribute(first + 1u) + v * fetchAttribute(first + 2u);
  }
  return c;
}

vec4 textureAt(uint texture, Coordinates at, bool srgb) {
  if (texture == kNowhere) return vec4(1.0);
  TextureRecord t = fetchTexture(texture);
  return sampleTexture(t, (t.flags & kTextureSecondSet) != 0u ? at.sets[1] : at.sets[0], srgb);
}

/// A material at a point.
struct MaterialPoint {
  SurfaceOptics optics;  // seen from outside
  vec3 emission;         // on the side of the normal
  float coverage;        // share of the surface that is there
  float base_weight;     // baseWeight; of a mirror it is 0 even where the shader leaves out metals
  bool double_sided;     // of emission
  bool varies;           // with the place, by textures or colours of vertices
};

/// @param m  its factors; @return  with what textures say at the point
MaterialPoint resolveMaterial(MaterialRecord m, Coordinates at) {
  vec4 base = m.base;
  if (kSceneHasTextures) {
    base *= textureAt(m.base_texture, at, true) * at.color;
    vec4 metallic_roughness = textureAt(m.metallic_roughness_texture, at, false);
    m.metallic *= metallic_roughness.z;
    m.roughness *= metallic_roughness.y;
    m.transmission *= textureAt(m.transmission_texture, at, false).x;
    m.specular_tint *= textureAt(m.specular_texture, at, false).w * textureAt(m.specular_color_texture, at, true).xyz;
    m.emission *= textureAt(m.emission_texture, at, true).xyz;
  }
  MaterialPoint p;
  p.emission = m.emission;
  p.double_sided = (m.flags & kMaterialDoubleSided) != 0u;
  p.varies = kSceneHasTextures && (m.flags & kMaterialVaries) != 0u;
  p.coverage = 1.0;
  if ((m.flags & kMaterialIsMask) != 0u) p.coverage = base.w >= m.alpha_cutoff ? 1.0 : 0.0;
  if ((m.flags & kMaterialIsBlend) != 0u) p.coverage = clamp(base.w, 0.0, 1.0);
  SurfaceOptics s;
  s.base = clamp(base.xyz, vec3(0.0), vec3(1.0));
  s.metallic = clamp(m.metallic, 0.0, 1.0);
  float roughness = clamp(m.roughness, 0.0, 1.0);
  s.alpha = roughness * roughness;
  s.transmission = clamp(m.transmission, 0.0, 1.0);
  s.gloss = kSceneHasGloss || kSceneHasPassable ? glossOf(s.alpha, s.transmission) : 0.0;
  if (s.alpha < kDeltaAlpha) s.alpha = 0.0;
  // A tint above 1 would reflect more than arrives.
  s.specular_tint = clamp(m.specular_tint, vec3(0.0), vec3(1.0));
  s.ior_from = 1.0;
  s.ior_to = m.ior;
  s.average_fresnel = m.average_fresnel;
  s.conductor_ior = m.conductor_ior;
  s.conductor_k = m.conductor_k;
  s.has_conductor = kSceneHasConductors && (m.flags & kMaterialHasConductor) != 0u ? 1u : 0u;
  s.is_solid = (m.flags & kMaterialIsSolid) != 0u ? 1u : 0u;
  s.is_pane = s.is_solid == 0u && s.transmission > 0.0 ? 1u : 0u;
  p.base_weight = baseWeight(s);
  if (!kSceneHasMetal) s.metallic = 0.0;
  p.optics = s;
  return p;
}

MaterialPoint materialAt(InstanceRecord instance, uint triangle, float u, float v) {
  Coordinates at = Coordinates(vec2[2](vec2(0.0), vec2(0.0)), vec4(1.0));
  if (kSceneHasTextures) at = coordinatesAt(instance, triangle, u, v);
  MaterialPoint point = resolveMaterial(fetchMaterial(instance.material), at);
  point.varies = point.varies || (kSceneHasTextures && instance.colors != kNowhere);
  return point;
}

/// What goes straight through a surface without an event: holes and smooth thin-walled transmission. As
/// passTransmittance of trace/surface_material.h.
/// @param cos_theta  |cosine| of incidence
vec3 passTransmittance(MaterialPoint m, float cos_theta) {
  vec3 pass = vec3(1.0 - m.coverage);
  if (m.optics.is_pane != 0u && m.optics.alpha == 0.0) {
    float r = fresnelThinPane(fresnelDielectric(cos_theta, 1.0 / m.optics.ior_to));
    pass += m.coverage * (1.0 - m.optics.metallic) * m.optics.transmission * m.optics.base *
            (vec3(1.0) - r * m.optics.specular_tint);
  }
  return pass;
}

/// The tangent and bitangent along which a normal map leans, or zero where there are none.
void tangentsAt(Surface s, TextureRecord t, out vec3 tangent, out vec3 bitangent) {
  tangent = bitangent = vec3(0.0);
  bool second = (t.flags & kTextureSecondSet) != 0u;
  if (s.instance.tangents != kNowhere && !second) {
    uint first = s.instance.tangents + 3u * s.triangle;
    vec4 local = (1.0 - s.u - s.v) * fetchAttribute(first) + s.u * fetchAttribute(first + 1u) +
                 s.v * fetchAttribute(first + 2u);
    tangent = vec3(dot(s.instance.row_x.xyz, local.xyz), dot(s.instance.row_y.xyz, local.xyz),
                   dot(s.instance.row_z.xyz, local.xyz));
    tangent -= dot(tangent, s.shading) * s.shading;
    bool flipped = ((s.instance.flags & kInstanceMirrored) != 0u) != (local.w < 0.0);
    bitangent = flipped ? -cross(s.shading, tangent) : cross(s.shading, tangent);
    return;
  }
  uint texcoords = second ? s.instance.texcoords_1 : s.instance.texcoords_0;
  if (texcoords == kNowhere) return;
  vec4 ab = fetchAttribute(texcoords + 2u * s.triangle), c = fetchAttribute(texcoords + 2u * s.triangle + 1u);
  vec2 du = ab.zw - ab.xy, dv = c.xy - ab.xy;
  float determinant = du.x * dv.y - du.y * dv.x;
  if (determinant == 0.0) return;
  vec3 e1 = s.corners.b - s.corners.a, e2 = s.corners.c - s.corners.a;
  tangent = (dv.y * e1 - du.y * e2) / determinant;
  // glTF's V runs down the image while tangent space's Y runs up it: the bitangent is against V.
  bitangent = -(du.x * e2 - dv.x * e1) / determinant;
  tangent -= dot(tangent, s.shading) * s.shading;
  bitangent -= dot(bitangent, s.shading) * s.shading;
}

/// The shading normal with the material's normal map.
vec3 perturbedNormal(Surface s) {
  MaterialRecord m = fetchMaterial(s.instance.material);
  if (!kSceneHasTextures || m.normal_texture == kNowhere) return s.shading;
  TextureRecord t = fetchTexture(m.normal_texture);
  vec3 tangent, bitangent;
  tangentsAt(s, t, tangent, bitangent);
  if (dot(tangent, tangent) == 0.0 || dot(bitangent, bitangent) == 0.0) return s.shading;
  Coordinates at = coordinatesAt(s.instance, s.triangle, s.u, s.v);
  vec4 texel = sampleTexture(t, (t.flags & kTextureSecondSet) != 0u ? at.sets[1] : at.sets[0], false);
  vec2 slope = m.normal_scale * (2.0 * texel.xy - 1.0);
  vec3 normal = normalize(slope.x * normalize(tangent) + slope.y * normalize(bitangent) +
                          max(2.0 * texel.z - 1.0, 1e-3) * s.shading);
  return dot(normal, s.geometric) > 0.0 ? normal : s.shading;
}

#endif
