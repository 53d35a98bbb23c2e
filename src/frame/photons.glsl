// A buffer of photons (frame/photon_buffer.h): one after the other, in the order of emission.
//
// The including shader gives the binding NEPHROID_PHOTON_BINDING; `photons[i]` is photon `first_photon + i` of the batch,
// where the buffer's chunk says first_photon.
#ifndef NEPHROID_PHOTONS_GLSL
#define NEPHROID_PHOTONS_GLSL

#include "core/optics/photon.shared.h"

layout(scalar, set = 0, binding = NEPHROID_PHOTON_BINDING) buffer Photons { Photon photons[]; };

#endif
