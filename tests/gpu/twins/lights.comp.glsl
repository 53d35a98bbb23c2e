#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lights_twin.shared.h"
#define TWIN_INPUT LightsInput
#define TWIN_OUTPUT LightsOutput
#define TWIN_FUNCTION evaluateLights
#include "../../support/twin.glsl"
