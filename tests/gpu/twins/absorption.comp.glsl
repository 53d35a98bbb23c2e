#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "absorption_twin.shared.h"
#define TWIN_INPUT AbsorptionInput
#define TWIN_OUTPUT AbsorptionOutput
#define TWIN_FUNCTION evaluateAbsorption
#include "../../support/twin.glsl"
