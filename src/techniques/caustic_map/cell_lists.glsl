// Lists of the cells of an emission grid that have something to say in a branch, so that the others cost nothing.
//
// The order in a list differs between runs; each photon has its place in the grid all the same. Every list begins with
// the number of groups of the pass that goes through it. Branch b reads its list while it writes that of b + 1: two
// halves of the buffer serve all branches.
//
// The including shader gives the binding NEPHROID_CELL_LISTS_BINDING.
#ifndef NEPHROID_CELL_LISTS_GLSL
#define NEPHROID_CELL_LISTS_GLSL

#include "techniques/caustic_map/transport.shared.h"

layout(scalar, set = 0, binding = NEPHROID_CELL_LISTS_BINDING) buffer CellLists {
  CellListHead heads[kMostBranches];
  uint listed[];
};

/// @param cells  of the whole grid
uint firstOfList(uint branch, uint cells) { return (branch & 1u) * cells; }

void addToList(uint branch, uint cells, uint cell) {
  uint place = atomicAdd(heads[branch].count, 1u);
  if (place % kListGroup == 0u) {
    uint group = place / kListGroup;
    atomicMax(heads[branch].groups_x, min(group + 1u, kMostGroups));
    atomicMax(heads[branch].groups_y, group / kMostGroups + 1u);
  }
  listed[firstOfList(branch, cells) + place] = cell;
}

#endif
