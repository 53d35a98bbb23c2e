#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "photon_twin.shared.h"
#define TWIN_INPUT PhotonInput
#define TWIN_OUTPUT PhotonOutput
#define TWIN_FUNCTION evaluatePhoton
#include "../../support/twin.glsl"
