// What the frame's shaders and C++ both see: the scene's tables, cameras and lights.
//
// Tables are buffers that are fetched in texels of four words (frame/tables.glsl), which software devices do ten times
// as fast as word by word. A record here is what C++ writes, word for word; its size is a multiple of 16 bytes.
#ifndef NEPHROID_FRAME_SHARED_H
#define NEPHROID_FRAME_SHARED_H

#include "core/optics/bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

/// "Not there": of textures, attributes, nodes.
NEPHROID_CONST uint kNowhere = 0xFFFFFFFFu;

/// One triangle of a mesh, object space.
struct TriangleRecord {
  vec3 a;
  uint normal_a;  // of the vertex, as packUnitVector
  vec3 b;
  uint normal_b;
  vec3 c;
  uint normal_c;
};

/// One mesh placed in the world.
struct InstanceRecord {
  // World from object, row by row: position = (dot(row, vec4(p, 1)), …).
  vec4 row_x;
  vec4 row_y;
  vec4 row_z;
  uint first_triangle;
  uint material;
  uint flags;  // kInstance…
  uint solid;  // instances of one object and one material bound one solid together
  // Where in the table of attributes those of the first triangle lie; kNowhere. A triangle has two texels of
  // coordinates, three of colours, three of tangents.
  uint texcoords_0;
  uint texcoords_1;
  uint colors;
  uint tangents;
};

NEPHROID_CONST uint kInstanceMirrored = 1u;    // the winding is reversed in world space
NEPHROID_CONST uint kInstanceHasNormals = 2u;  // else flat
NEPHROID_CONST uint kInstancePassable = 4u;    // its material may let light pass straight through
NEPHROID_CONST uint kInstanceGenerates = 8u;   // casts caustics
NEPHROID_CONST uint kInstanceClosed = 16u;     // what enters it must leave it; known of scenes with generators
NEPHROID_CONST uint kInstanceReceives = 32u;   // catches caustics
NEPHROID_CONST uint kInstanceIsLit = 64u;      // shines, or has a lobe of class D; textures may give it either

/// A material; see scene/scene_data.h for the terms. Indices of textures are kNowhere where there is none.
struct MaterialRecord {
  vec4 base;
  vec3 emission;  // W/m²/sr
  float metallic;
  vec3 specular_tint;  // factor times colour
  float roughness;
  float transmission;
  float ior;
  float average_fresnel;  // towards the material from vacuum
  uint flags;             // kMaterial…
  vec3 conductor_ior;
  float alpha_cutoff;
  vec3 conductor_k;
  float normal_scale;
  uint base_texture;
  uint metallic_roughness_texture;
  uint normal_texture;
  uint emission_texture;
  uint transmission_texture;
  uint specular_texture;
  uint specular_color_texture;
  int priority;  // where solids overlap
  // Of what a solid is filled with.
  vec3 sigma_a;      // 1/m
  float dispersion;  // 20 / Abbe number
};

NEPHROID_CONST uint kMaterialHasConductor = 1u;
NEPHROID_CONST uint kMaterialIsSolid = 2u;
NEPHROID_CONST uint kMaterialDoubleSided = 4u;  // of emission only
NEPHROID_CONST uint kMaterialIsMask = 8u;       // alpha decides whether the surface is there
NEPHROID_CONST uint kMaterialIsBlend = 16u;     // alpha is how much of it is there
NEPHROID_CONST uint kMaterialIsSpecular = 32u;  // has a lobe of class S, or textures may give it one
NEPHROID_CONST uint kMaterialVaries = 64u;      // by textures

/// How a material uses an image.
struct TextureRecord {
  uint first_texel;  // in its table of texels
  uint width;
  uint height;
  uint flags;  // kTexture…
  vec3 row_u;  // coordinates in the image from those of the mesh
  float pad_u;
  vec3 row_v;
  float pad_v;
};

NEPHROID_CONST uint kTextureIsFloat = 1u;  // in the table of floats, else of bytes
NEPHROID_CONST uint kTextureIsNearest = 2u;
NEPHROID_CONST uint kTextureSecondSet = 4u;
NEPHROID_CONST uint kTextureWrapU = 3u;  // shift of two bits: 0 repeats, 1 clamps, 2 mirrors
NEPHROID_CONST uint kTextureWrapV = 5u;

/// From where a picture of the scene is taken: pixel centres to rays, and world to clip space.
struct ViewRecord {
  vec4 clip_row_x;  // clip from world, row by row; clip z from w (near) to 0 (far)
  vec4 clip_row_y;
  vec4 clip_row_z;
  vec4 clip_row_w;
  vec3 eye;  // perspective: the eye; orthographic: the middle of the plane that rays start on
  uint is_orthographic;
  vec3 forward;
  float film_x;  // place of the sample in each pixel, in [0, 1)
  vec3 right;    // of half the picture's width: at distance 1, or in m if orthographic
  float film_y;
  vec3 up;  // likewise of half its height
  float pad_up;
};

/// Views in a table of them at the most, which has room for so many: the faces of a cube, or those along axes.
NEPHROID_CONST uint kMostViews = 6u;

/// How to find places from somebody else's depths and normals.
struct ForeignViewRecord {
  vec4 world_row_x;  // world from clip, row by row; homogeneous
  vec4 world_row_y;
  vec4 world_row_z;
  vec4 world_row_w;
  float depth_step;        // between two depths that the format tells apart,
  float depth_ulp;         // and the same relative to the depth
  uint normals_are_coded;  // as 0.5 + 0.5 n
  uint pad;
};

/// Of so many lights, or fewer, shaders have code for each; frame/shade_blocks.comp.glsl and
/// frame/specular_lit.comp.glsl keep as many words.
NEPHROID_CONST uint kMostFewLights = 2u;

/// A light as a point or a direction that shines, for one sample of it.
struct LightRecord {
  vec3 position;    // of a point
  uint kind;        // kLight…
  vec3 direction;   // spot: its axis; directional: of the travel of light
  float cos_outer;  // spot
  vec3 value;       // point, spot: W/sr; directional: W/m² on what faces it
  float cos_inner;  // spot
  vec3 normal;      // of the surface that the point lies on: the value is then times the cosine to it
  uint surface;     // kSurface…
  uint view_count;  // 6: a cube of views along ±x, ±y, ±z; 1; 0: it does not shine
  uint grid_size;   // cells along a side of each view
  uint has_size;    // 1: this is one point of it, or one direction
  uint first_head;  // of its lists
  // Directional: the place on its grid, in cells, of a place in the world. Of a cube of views it follows without.
  vec4 grid_row_x;
  vec4 grid_row_y;
};

NEPHROID_CONST uint kLightPoint = 0u;
NEPHROID_CONST uint kLightSpot = 1u;
NEPHROID_CONST uint kLightDirectional = 2u;

NEPHROID_CONST uint kSurfaceNone = 0u;   // a point in the open
NEPHROID_CONST uint kSurfaceFront = 1u;  // shines to the side of its normal
NEPHROID_CONST uint kSurfaceBoth = 2u;

/// A light with a size, as it is seen: a sphere, or a disc infinitely far away.
struct LampRecord {
  vec3 position;
  float radius;   // m; 0: a sun
  vec3 radiance;  // W/m²/sr; of a spot on its axis
  float cos_outer;
  vec3 direction;  // sun, spot: along the travel of light
  float cos_inner;
  float one_minus_cos;  // sun: of half its angle
  uint is_spot;
  uint pad_0;
  uint pad_1;
};

/// An entry of the list of a cell: see light_grid.comp.glsl. Its triangle, world: fetched through instance and mesh it
/// would be read from three places.
struct GridNode {
  vec3 a;
  uint next;  // kNowhere at the end
  vec3 b;
  uint instance;  // and, above it, kNodePassable
  vec3 c;
  uint triangle;
};

NEPHROID_CONST uint kNodePassable = 0x80000000u;

/// A box of the tree of triangles: see frame/triangle_tree.h.
struct TreeNode {
  vec3 lower;  // world; of orders by octant, coordinates that fall along its directions times -1
  uint link;   // of a leaf: kTreeLeaf + first triangle · 4 + how many; else the node where a walk goes on that misses
               // the box, their number at the end
  vec3 upper;
  uint pad;
};

/// A box on the grid of the tree, 16 bits a coordinate, rounded outwards; of orders by octant, coordinates that fall
/// are told from the grid's other end.
struct CompactTreeNode {
  uint lower_xy;  // x low
  uint lower_z_upper_x;
  uint upper_yz;
  uint link;  // as above
};

NEPHROID_CONST uint kTreeLeaf = 0x80000000u;
/// The last place of the grid.
NEPHROID_CONST float kTreeGridEnd = 65535.0f;

/// A triangle of the tree, world.
struct TreeTriangle {
  vec3 a;
  uint instance;
  vec3 b;
  uint triangle;
  vec3 c;
  uint pad;
};

/// Cells of the fine grid along a side of one of the coarse grid, where the lists of large triangles are.
NEPHROID_CONST uint kCoarseCell = 8u;

NEPHROID_NAMESPACE_END

#endif
