#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "ray_differential_twin.shared.h"
#define TWIN_INPUT RayDifferentialInput
#define TWIN_OUTPUT RayDifferentialOutput
#define TWIN_FUNCTION evaluateRayDifferential
#include "../../support/twin.glsl"
