// Lists of the cells of an emission grid that have something to say, so that the others cost nothing.
//
// The order in a list differs between runs; each photon has its place in the grid all the same. Every list begins with
// the number of groups of the pass that goes through it. Lists are made and gone through one after the other and share
// their place, but for the one of cells whose weaker way is followed.
//
// The including shader gives the binding NEPHROID_CELL_LISTS_BINDING.
#ifndef NEPHROID_CELL_LISTS_GLSL
#define NEPHROID_CELL_LISTS_GLSL

#include "techniques/caustic_map/transport.shared.h"

layout(scalar, set = 0, binding = NEPHROID_CELL_LISTS_BINDING) buffer CellLists {
  CellListHead heads[kCellLists];
  uint listed[];
};

/// @param cells  of the whole grid
uint firstOfList(uint list, uint cells) { return list == kWeakerList ? cells : 0u; }

/// @param list  TransportPush::list
void addToList(uint list, uint cells, uint cell) {
  uint place = atomicAdd(heads[list].count, 1u);
  if (place % kListGroup == 0u) {
    uint group = place / kListGroup;
    atomicMax(heads[list].groups_x, min(group + 1u, kMostGroups));
    atomicMax(heads[list].groups_y, group / kMostGroups + 1u);
  }
  listed[firstOfList(list, cells) + place] = cell;
}

#endif
