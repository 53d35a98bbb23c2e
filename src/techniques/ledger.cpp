#include "techniques/ledger.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace nephroid {
namespace {

double luminance(const dvec3& rgb) { return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z; }

std::string formatLine(std::string_view name, const dvec3& flux, const Ledger& ledger) {
  const double emitted = luminance(ledger.emitted);
  return fmt::format("  {:<26}{:>12.6g} W{:>10.4f} %\n", name, luminance(flux),
                     emitted != 0.0 ? 100.0 * luminance(flux) / emitted : 0.0);
}

nlohmann::json toJson(const dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

std::string_view lossReasonName(LossReason reason) {
  switch (reason) {
    case LossReason::kBounceLimit:
      return "bounce limit";
    case LossReason::kMicrofacet:
      return "between microfacets";
    case LossReason::kShadingNormal:
      return "interpolated normal";
    case LossReason::kInteriorOverflow:
      return "nested too deep";
    case LossReason::kNumerical:
      return "not a number";
    case LossReason::kHidden:
      return "not seen from the light";
    case LossReason::kInternalReflections:
      return "reflected inside too often";
    case LossReason::kOtherWay:
      return "the weaker of two ways";
    case LossReason::kDiffuseShare:
      return "diffuse part of generators";
    case LossReason::kCount:
      break;
  }
  return "unknown";
}

void Ledger::add(const Ledger& other) {
  emitted_count += other.emitted_count;
  emitted += other.emitted;
  missed += other.missed;
  blocked += other.blocked;
  absorbed += other.absorbed;
  escaped += other.escaped;
  deposited += other.deposited;
  for (std::size_t i = 0; i < lost.size(); ++i) lost[i] += other.lost[i];
  roulette += other.roulette;
  roulette_squared += other.roulette_squared;
}

void Ledger::scale(double factor) {
  for (dvec3* flux : {&emitted, &missed, &blocked, &absorbed, &escaped, &deposited, &roulette}) *flux *= factor;
  for (dvec3& flux : lost) flux *= factor;
  roulette_squared *= factor * factor;
}

dvec3 Ledger::lostTotal() const {
  dvec3 sum(0.0);
  for (const dvec3& flux : lost) sum += flux;
  return sum;
}

double Ledger::residual() const {
  const dvec3 rest = emitted - missed - blocked - absorbed - escaped - deposited - lostTotal() - roulette;
  double worst = 0.0;
  for (int c = 0; c < 3; ++c)
    if (emitted[c] != 0.0) worst = std::max(worst, std::abs(rest[c] / emitted[c]));
  return worst;
}

dvec3 Ledger::rouletteStandardError() const {
  // Each photon adds an independent amount of expectation 0, so the sum's variance is the sum of squares.
  return glm::sqrt(roulette_squared);
}

std::string formatLedgers(const std::vector<Ledger>& ledgers) {
  std::string text;
  for (const Ledger& ledger : ledgers) {
    text += fmt::format("light '{}': {} photons\n", ledger.light, ledger.emitted_count);
    text += formatLine("emitted to generators", ledger.emitted, ledger);
    text += formatLine("missed everything", ledger.missed, ledger);
    text += formatLine("blocked before", ledger.blocked, ledger);
    text += formatLine("absorbed", ledger.absorbed, ledger);
    text += formatLine("escaped after", ledger.escaped, ledger);
    text += formatLine("deposited on receivers", ledger.deposited, ledger);
    for (std::size_t i = 0; i < ledger.lost.size(); ++i)
      if (ledger.lost[i] != dvec3(0.0))
        text += formatLine(fmt::format("lost: {}", lossReasonName(static_cast<LossReason>(i))), ledger.lost[i], ledger);
    text += formatLine("roulette (expected 0)", ledger.roulette, ledger);
    text += formatLine("  its standard error", ledger.rouletteStandardError(), ledger);
    text += fmt::format("  closes to {:.1e}\n", ledger.residual());
  }
  return text;
}

std::string formatLedgersJson(const std::vector<Ledger>& ledgers) {
  nlohmann::json list = nlohmann::json::array();
  for (const Ledger& ledger : ledgers) {
    nlohmann::json lost;
    for (std::size_t i = 0; i < ledger.lost.size(); ++i)
      lost[std::string(lossReasonName(static_cast<LossReason>(i)))] = toJson(ledger.lost[i]);
    list.push_back({{"light", ledger.light},
                    {"emitted_count", ledger.emitted_count},
                    {"emitted", toJson(ledger.emitted)},
                    {"missed", toJson(ledger.missed)},
                    {"blocked", toJson(ledger.blocked)},
                    {"absorbed", toJson(ledger.absorbed)},
                    {"escaped", toJson(ledger.escaped)},
                    {"deposited", toJson(ledger.deposited)},
                    {"lost", lost},
                    {"roulette", toJson(ledger.roulette)},
                    {"roulette_standard_error", toJson(ledger.rouletteStandardError())},
                    {"residual", ledger.residual()}});
  }
  return list.dump(2);
}

std::vector<std::string> diagnoseLedgers(const std::vector<Ledger>& ledgers) {
  if (ledgers.empty())
    return {"no photon was emitted: no light reaches anything that mirrors or refracts (see 'nephroid info')"};
  std::vector<std::string> sentences;
  for (const Ledger& ledger : ledgers) {
    const double emitted = luminance(ledger.emitted);
    if (emitted <= 0.0) continue;
    const auto share = [&](const dvec3& flux) { return luminance(flux) / emitted; };
    const auto say = [&](std::string_view what, double part) {
      sentences.push_back(fmt::format("light '{}': {:.1f} % {}", ledger.light, 100.0 * part, what));
    };
    if (share(ledger.deposited) > 0.05) continue;
    say("of what it sends to the generators ends on a receiver", share(ledger.deposited));
    if (share(ledger.blocked) > 0.3)
      say("is blocked by something opaque in front of the generators", share(ledger.blocked));
    if (share(ledger.missed) > 0.6) say("misses them: they are thin or small for their outline", share(ledger.missed));
    if (share(ledger.absorbed) > 0.3) say("is absorbed: check attenuation and metal colours", share(ledger.absorbed));
    if (share(ledger.escaped) > 0.3)
      say("leaves the scene after them: no receiver lies that way (try --floor on)", share(ledger.escaped));
    for (std::size_t i = 0; i < ledger.lost.size(); ++i)
      if (share(ledger.lost[i]) > 0.05)
        say(fmt::format("is lost: {}", lossReasonName(static_cast<LossReason>(i))), share(ledger.lost[i]));
  }
  return sentences;
}

}  // namespace nephroid
