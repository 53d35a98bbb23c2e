#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "microfacet_twin.shared.h"
#define TWIN_INPUT MicrofacetInput
#define TWIN_OUTPUT MicrofacetOutput
#define TWIN_FUNCTION evaluateMicrofacet
#include "../../support/twin.glsl"
