// Every photon is accounted for: where the flux that a light sends towards the generators ends (DESIGN §2).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"

namespace nephroid {

/// Why a photon was lost: neither deposited nor absorbed nor gone.
enum class LossReason : std::uint8_t {
  kBounceLimit,       ///< more scattering events than `max-bounces`
  kMicrofacet,        ///< left a rough lobe on the wrong side of the surface (single-scattering model)
  kShadingNormal,     ///< the interpolated normal sends it through the true surface
  kInteriorOverflow,  ///< inside more nested solids than the interior list holds
  kNumerical,         ///< not a number: counted, never dropped silently
  // Of techniques that follow light in pictures, and follow some of its ways.
  kHidden,               ///< what it meets is in no picture that the light takes
  kInternalReflections,  ///< still inside where the last branch leaves
  kOtherWay,             ///< of two ways on the one that carries less
  kDiffuseShare,         ///< falls on the diffuse part of what bends light as well
  kCount
};
std::string_view lossReasonName(LossReason reason);

/// Flux in W per channel, double: sums of up to 1e10 photons in fixed order.
struct Ledger {
  std::string light;
  std::uint64_t emitted_count = 0;
  dvec3 emitted{0};    ///< through the emission domain that is aimed at the generators
  dvec3 missed{0};     ///< met nothing at all
  dvec3 blocked{0};    ///< first met something that does not bend it (or a generator's own diffuse lobe)
  dvec3 absorbed{0};   ///< in media and by generators
  dvec3 escaped{0};    ///< left the scene after a generator
  dvec3 deposited{0};  ///< incident on D lobes of receivers at the first D event after at least one S event
  std::array<dvec3, static_cast<std::size_t>(LossReason::kCount)> lost{};
  dvec3 roulette{0};          ///< killed minus boosted; its expectation is 0
  dvec3 roulette_squared{0};  ///< sum of squares per photon, for its standard error

  void add(const Ledger& other);
  /// Multiplies every flux: from sums over photons to watts.
  void scale(double factor);
  dvec3 lostTotal() const;
  /// (emitted − everything else) / emitted of the worst channel; closes when |residual| <= 1e-5.
  double residual() const;
  dvec3 rouletteStandardError() const;

  /// Visits all sums, with `value(number)`, in a fixed order; not the light's name.
  template <class State>
  void visitState(State& state) {
    state.value(emitted_count);
    for (dvec3* sum : {&emitted, &missed, &blocked, &absorbed, &escaped, &deposited, &roulette, &roulette_squared})
      state.value(*sum);
    for (dvec3& sum : lost) state.value(sum);
  }
};

/// The table that `render --verbose` prints, and JSON.
std::string formatLedgers(const std::vector<Ledger>& ledgers);
std::string formatLedgersJson(const std::vector<Ledger>& ledgers);

/// Sentences that answer "why is there no caustic here?", most important first; empty when all is well.
std::vector<std::string> diagnoseLedgers(const std::vector<Ledger>& ledgers);

}  // namespace nephroid
