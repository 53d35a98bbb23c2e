#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "fresnel_twin.shared.h"
#define TWIN_INPUT FresnelInput
#define TWIN_OUTPUT FresnelOutput
#define TWIN_FUNCTION evaluateFresnel
#include "../../support/twin.glsl"
