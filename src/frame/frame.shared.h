// What the frame's shaders and C++ both see: the scene's tables, cameras and light views. Scalar block layout.
#ifndef NEPHROID_FRAME_SHARED_H
#define NEPHROID_FRAME_SHARED_H

#include "core/optics/bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

/// One mesh placed in the world.
struct InstanceRecord {
  // World from object, row by row: position = (dot(row, vec4(p, 1)), …).
  vec4 row_x;
  vec4 row_y;
  vec4 row_z;
  uint first_vertex;  // of its mesh in the tables of vertices
  uint first_index;   // of its mesh in the table of indices
  uint material;
  uint flags;  // kInstance…
};

NEPHROID_CONST uint kInstanceMirrored = 1u;    // the winding is reversed in world space
NEPHROID_CONST uint kInstanceHasNormals = 2u;  // else flat

/// A material without its textures; see SurfaceOptics for the terms.
struct MaterialRecord {
  vec3 base;
  float metallic;
  vec3 specular_tint;
  float alpha;
  vec3 emission;  // W/m²/sr
  float transmission;
  vec3 conductor_ior;
  float gloss;
  vec3 conductor_k;
  float ior;
  float average_fresnel;  // towards the material from vacuum
  uint flags;             // kMaterial…
};

NEPHROID_CONST uint kMaterialHasConductor = 1u;
NEPHROID_CONST uint kMaterialIsPane = 2u;
NEPHROID_CONST uint kMaterialIsSolid = 4u;
NEPHROID_CONST uint kMaterialDoubleSided = 8u;  // of emission only

/// From where a picture of the scene is taken: pixel centres to rays, and world to clip space.
struct ViewRecord {
  vec4 clip_row_x;  // clip from world, row by row; clip z from w (near) to 0 (far)
  vec4 clip_row_y;
  vec4 clip_row_z;
  vec4 clip_row_w;
  vec3 eye;  // perspective: the eye; orthographic: the middle of the plane that rays start on
  uint is_orthographic;
  vec3 forward;
  vec3 right;  // of half the picture's width: at distance 1, or in m if orthographic
  vec3 up;     // likewise of half its height
};

/// One view of a light: the scene as seen from a point or along a direction of it, for one sample of the light.
struct LightRecord {
  vec3 position;    // of a point
  uint kind;        // kLight…
  vec3 direction;   // spot: its axis; directional: of the travel of light
  float cos_outer;  // spot
  vec3 value;       // point, spot: W/sr; directional: W/m² on what faces it
  float cos_inner;  // spot
  vec3 normal;      // of the surface that the point lies on: the value is then times the cosine to it
  uint surface;     // kSurface…
  uint view_count;  // 6: a cube of views along ±x, ±y, ±z; 1
  float grid_size;  // cells along a side of each view
};

NEPHROID_CONST uint kLightPoint = 0u;
NEPHROID_CONST uint kLightSpot = 1u;
NEPHROID_CONST uint kLightDirectional = 2u;

NEPHROID_CONST uint kSurfaceNone = 0u;   // a point in the open
NEPHROID_CONST uint kSurfaceFront = 1u;  // shines to the side of its normal
NEPHROID_CONST uint kSurfaceBoth = 2u;

/// An entry of the list of a cell: see light_grid.comp.glsl.
struct GridNode {
  uint instance;
  uint triangle;
  uint next;  // kNoNode at the end
  // Its corners, world: fetched through instance and indices they would be read from five places.
  vec3 a;
  vec3 b;
  vec3 c;
};

NEPHROID_CONST uint kNoNode = 0xFFFFFFFFu;

NEPHROID_NAMESPACE_END

#endif
