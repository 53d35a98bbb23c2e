// The technique `reference`: the truth that every real-time picture is held against.
//
// Progressive. Path tracing makes everything that begins or ends at the eye with chance on its side, light tracing the
// caustics; DESIGN §2's layers say which is which, so each path is counted exactly once.
#pragma once

#include "techniques/technique.h"

namespace nephroid {

Technique makeReferenceTechnique();

}  // namespace nephroid
