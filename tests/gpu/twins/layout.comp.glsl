#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "layout_twin.shared.h"
#define TWIN_INPUT LayoutInput
#define TWIN_OUTPUT LayoutOutput
#define TWIN_FUNCTION writeLayout
#include "../../support/twin.glsl"
