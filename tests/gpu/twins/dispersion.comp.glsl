#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "dispersion_twin.shared.h"
#define TWIN_INPUT DispersionInput
#define TWIN_OUTPUT DispersionOutput
#define TWIN_FUNCTION evaluateDispersion
#include "../../support/twin.glsl"
