#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "tonemap_twin.shared.h"
#define TWIN_INPUT TonemapInput
#define TWIN_OUTPUT TonemapOutput
#define TWIN_FUNCTION evaluateTonemap
#include "../../support/twin.glsl"
