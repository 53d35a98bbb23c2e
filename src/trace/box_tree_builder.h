// Trees of boxes for rays that are not traced by Embree, built by Embree.
#pragma once

#include "core/box_tree.h"

namespace nephroid {

/// By the surface area heuristic [wald-2007], on all threads that a loop may use. A BoxTreeBuilder. Thread-safe.
/// @param costs  leaves of up to 32 primitives
/// @throws ResourceError if memory does not suffice
BoxTree buildBoxTree(std::span<const Bounds> boxes, const BoxTreeCosts& costs);

}  // namespace nephroid
