// What several techniques take from their settings in the same way.
#pragma once

#include <cstdint>

#include "core/params.h"

namespace nephroid {

/// `specular-alpha`: what counts as an S event.
ParamSpec makeSpecularAlphaParam();

/// A 64-bit seed for generators of 32. Equal seeds give equal pictures, which is all that is promised.
constexpr std::uint32_t foldSeed(std::uint64_t seed) { return static_cast<std::uint32_t>(seed ^ (seed >> 32)); }

}  // namespace nephroid
