// Photons read as texels of a buffer (frame/photon_buffer.h), for passes that do not write them.
//
// The including shader gives the binding NEPHROID_PHOTON_BINDING.
#ifndef NEPHROID_FETCH_PHOTON_GLSL
#define NEPHROID_FETCH_PHOTON_GLSL

#include "core/optics/photon.shared.h"

layout(set = 0, binding = NEPHROID_PHOTON_BINDING) uniform usamplerBuffer photon_texels;

Photon fetchPhoton(uint i) {
  uvec4 place = texelFetch(photon_texels, int(4u * i)), along = texelFetch(photon_texels, int(4u * i + 1u)),
        flux = texelFetch(photon_texels, int(4u * i + 2u)), last = texelFetch(photon_texels, int(4u * i + 3u));
  return Photon(uintBitsToFloat(place.xyz), uintBitsToFloat(place.w), uintBitsToFloat(along.xyz), along.w,
                uintBitsToFloat(flux.xyz), flux.w, last.x, uintBitsToFloat(last.y), uintBitsToFloat(last.z), last.w);
}

#endif
