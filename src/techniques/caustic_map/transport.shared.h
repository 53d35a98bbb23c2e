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

struct TransportPush {
  uint grid;    // cells along a side of a view's grid
  uint light;   // in the table of lights
  uint view;    // of the emission, among those of the light
  uint branch;  // 0: reflected at the first surface; b >= 1: enters, and leaves at its b-th chance
  uint max_events;
  vec2 offset;  // of the photon in its cell, in [0, 1)
  uint generator_views;
  uint generator_layers;
  uint receiver_views;
  float generator_size;
  float receiver_size;
  uint iterations;
  vec3 generator_lower;  // bounds of what casts caustics, and of everything
  vec3 generator_upper;
  vec3 scene_lower;
  vec3 scene_upper;
};

NEPHROID_NAMESPACE_END

#endif
