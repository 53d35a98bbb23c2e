#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "surface_twin.shared.h"
#define TWIN_INPUT SurfaceInput
#define TWIN_OUTPUT SurfaceOutput
#define TWIN_FUNCTION evaluateSurface
#include "../../support/twin.glsl"
