#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "refraction_twin.shared.h"
#define TWIN_INPUT RefractionInput
#define TWIN_OUTPUT RefractionOutput
#define TWIN_FUNCTION evaluateRefraction
#include "../../support/twin.glsl"
