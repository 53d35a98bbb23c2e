// The technique `none`: the real-time frame without any caustic. What the others add their caustics to, and what they
// are timed against.
#pragma once

#include "techniques/technique.h"

namespace nephroid {

Technique makeNoneTechnique();

}  // namespace nephroid
