// Where the cells of an emission grid stand: which branch each waits for, if any.
//
// The including shader gives the binding NEPHROID_STANDINGS_BINDING.
#ifndef NEPHROID_STANDINGS_GLSL
#define NEPHROID_STANDINGS_GLSL

#include "core/optics/bridge.shared.h"

layout(scalar, set = 0, binding = NEPHROID_STANDINGS_BINDING) buffer Standings { uint standings[]; };

/// Of a cell that no branch to come has anything to say of.
const uint kIsDone = 0u;

/// @param has_fork  its flight was kept where it forked; else it is followed from the light on
uint waitsFor(uint branch, bool has_fork) { return (branch + 1u) << 1 | (has_fork ? 1u : 0u); }
bool isWaitingFor(uint standing, uint branch) { return standing >> 1 == branch + 1u; }
bool hasFork(uint standing) { return (standing & 1u) != 0u; }

#endif
