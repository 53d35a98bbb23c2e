// What the passes of caustic maps and C++ tell each other.
#ifndef NEPHROID_CAUSTIC_TRANSPORT_SHARED_H
#define NEPHROID_CAUSTIC_TRANSPORT_SHARED_H

#include "core/optics/photon.shared.h"

NEPHROID_NAMESPACE_BEGIN

/// Why a photon is not valid, in its flags above those of the record.
NEPHROID_CONST uint kOutcomeShift = 3u;
NEPHROID_CONST uint kOutcomeDeposited = 0u;
NEPHROID_CONST uint kOutcomeMissed = 1u;   // met nothing at all
NEPHROID_CONST uint kOutcomeBlocked = 2u;  // first met what is no generator
NEPHROID_CONST uint kOutcomeEscaped = 3u;  // met nothing after a generator
NEPHROID_CONST uint kOutcomeHidden = 4u;   // what it met is not in the pictures
NEPHROID_CONST uint kOutcomeBounceLimit = 5u;
NEPHROID_CONST uint kOutcomeInterior = 6u;  // inside more solids than the list holds
NEPHROID_CONST uint kOutcomeAbsorbed = 7u;  // nothing of it is left
NEPHROID_CONST uint kOutcomeNoWay = 8u;     // there is no such branch, or another one has it

NEPHROID_CONST uint kOutcomeNumerical = 9u;  // not a number
NEPHROID_CONST uint kOutcomeCount = 10u;

/// Another flag: what a photon met varies by textures, so that nothing is known of those beside it. Of cells of lists.
NEPHROID_CONST uint kPhotonVaries = 128u;

/// Where the flux of a cell stayed that its photon does not carry, W: for the ledger. Of what branches have in common
/// each share is in the account of one of them.
struct PhotonAccount {
  vec3 emitted;     // of the first branch: the light's flux through the cell
  vec3 blocked;     // by the diffuse lobe of the generator that is met first
  vec3 absorbed;    // in media and by generators
  vec3 diffuse;     // share of the diffuse lobes of generators that are met later and get no photon
  vec3 other_way;   // where a branch follows one of two ways and no branch the other
  vec3 internal;    // still inside where the last branch leaves
  vec3 normal;      // sent through the true surface by an interpolated normal
  vec3 microfacet;  // met more than one facet
  vec3 landed;      // share of the diffuse lobes of generators that get one
};

/// Words of a record of sums: each member of PhotonAccount in order, then the photons' flux by outcome.
NEPHROID_CONST uint kAccountKinds = 9u;
NEPHROID_CONST uint kLedgerKinds = kAccountKinds + kOutcomeCount;
/// Photons that a thread adds up: few enough that rounding does not count.
NEPHROID_CONST uint kLedgerRow = 64u;

// How it is found what light meets: Search and Exit of transport.h.
NEPHROID_CONST uint kSearchTree = 0u;     // triangle_tree.glsl
NEPHROID_CONST uint kSearchPlanes = 1u;   // layered_view.glsl
NEPHROID_CONST uint kSearchIterate = 2u;  // these: receiver_search.glsl
NEPHROID_CONST uint kSearchNewton = 3u;
NEPHROID_CONST uint kSearchSecant = 4u;
NEPHROID_CONST uint kSearchMarch = 5u;
NEPHROID_CONST uint kExitExact = 0u;
NEPHROID_CONST uint kExitWyman = 1u;

/// Photons that a branch may leave on diffuse lobes of generators on its way: the path goes on from each, so it has
/// photons besides the one at its end. Between two surfaces that send on half of what they get, three quarters of what
/// there is end so.
NEPHROID_CONST uint kLandings = 2u;

/// Branches that may be followed by lists of cells.
NEPHROID_CONST uint kMostBranches = 16u;
/// Cells between photons that are followed first: halved again and again, each time a list.
NEPHROID_CONST uint kMostSpacing = 4u;
NEPHROID_CONST uint kListsEach = 3u;
/// The list of cells whose weaker way is followed, after those of the branches.
NEPHROID_CONST uint kWeakerList = kMostBranches * kListsEach;
NEPHROID_CONST uint kCellLists = kWeakerList + 1u;
/// What a pass is: the last of those of branches; one that follows the weaker way.
NEPHROID_CONST uint kRoleIsLast = 1u;
NEPHROID_CONST uint kRoleIsWeaker = 2u;
/// Cells of a list that a group of threads follows.
NEPHROID_CONST uint kListGroup = 64u;
/// Groups along one axis, which every device allows.
NEPHROID_CONST uint kMostGroups = 32768u;

struct CellListHead {
  uint groups_x;  // of the pass that goes through the list
  uint groups_y;
  uint groups_z;
  uint count;
};

/// A flight where its way forks, as the next branch takes it up; what it is inside of, an Interior, is kept apart.
struct Fork {
  vec3 origin;
  uint instance;  // on which it starts
  vec3 dir;
  uint triangle;
  vec3 flux;  // W
  uint chain;
  uint events;
  uint turn;  // of the loop
  uint seed;
  int closed;
};
NEPHROID_CONST uint kInteriorWords = 12u;

/// What it takes to find a place in a view's picture.
struct PictureView {
  vec4 clip_row_x;  // of ViewRecord
  vec4 clip_row_y;
  vec4 clip_row_w;
  vec3 forward;
  float extent;  // the picture's longer side: at distance 1, or in m if orthographic
};

/// Bounds of what casts caustics, and of everything, m.
struct Surroundings {
  vec3 generator_lower;
  vec3 generator_upper;
  vec3 scene_lower;
  vec3 scene_upper;
};

struct TransportPush {
  uint grid;    // cells along a side of a view's grid
  uint light;   // in the table of lights
  uint view;    // of the emission, among those of the light
  uint branch;  // 0: reflected at the first surface; b >= 1: enters, and leaves at its b-th chance
  uint max_events;
  vec2 offset;  // of the photon in its cell, in [0, 1)
  float generator_size;
  float receiver_size;
  uint iterations;
  uint receiver_iterations;
  float first_guess;    // m; of receiver_search.glsl
  uint role;            // kRole…
  uint list;            // that is made or gone through
  uint spacing;         // cells between photons of that list
  uint squares_across;  // of PhotonBuffer::squares; 0: they are not asked for
  float wavelength_nm;  // of the band; 0: nothing disperses
  vec3 band_weight;     // of the light's flux
  uint band;
  uint seed;             // of microfacets
  float specular_alpha;  // an interface of a larger one is a diffuse lobe
  uint tree_nodes;       // TriangleTree::Walk
  vec3 tree_grid_lower;
  float tree_grid_scale;
};

NEPHROID_NAMESPACE_END

#endif
