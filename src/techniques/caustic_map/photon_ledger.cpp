#include "techniques/caustic_map/photon_ledger.h"

#include "core/assert.h"
#include "frame/passes.h"
#include "shaders/techniques/ledger_rows.comp.h"
#include "shaders/techniques/ledger_sum.comp.h"

namespace nephroid {
namespace {

static_assert(sizeof(PhotonAccount) == kAccountKinds * sizeof(vec3));

constexpr std::uint32_t kRowGroup = 64;

struct Push {
  std::uint32_t first, second;
};

gpu::Buffer makeTable(gpu::Device& device, std::uint64_t bytes, const char* name) {
  return {device, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryIntent::kDevice, name};
}

dvec3& lost(Ledger& ledger, LossReason reason) { return ledger.lost[static_cast<std::size_t>(reason)]; }

/// @param sums  kLedgerKinds of them
void addSums(Ledger& ledger, std::span<const vec3> sums) {
  ledger.emitted += dvec3(sums[0]);
  ledger.blocked += dvec3(sums[1]);
  ledger.absorbed += dvec3(sums[2]);
  lost(ledger, LossReason::kDiffuseShare) += dvec3(sums[3]);
  lost(ledger, LossReason::kOtherWay) += dvec3(sums[4]);
  lost(ledger, LossReason::kInternalReflections) += dvec3(sums[5]);
  lost(ledger, LossReason::kShadingNormal) += dvec3(sums[6]);
  lost(ledger, LossReason::kMicrofacet) += dvec3(sums[7]);
  ledger.deposited += dvec3(sums[8]);
  const std::span<const vec3> ends = sums.subspan(kAccountKinds);
  ledger.deposited += dvec3(ends[kOutcomeDeposited]);
  ledger.missed += dvec3(ends[kOutcomeMissed]);
  ledger.blocked += dvec3(ends[kOutcomeBlocked]);
  ledger.escaped += dvec3(ends[kOutcomeEscaped]);
  ledger.absorbed += dvec3(ends[kOutcomeAbsorbed]);
  lost(ledger, LossReason::kHidden) += dvec3(ends[kOutcomeHidden]);
  lost(ledger, LossReason::kBounceLimit) += dvec3(ends[kOutcomeBounceLimit]);
  lost(ledger, LossReason::kInteriorOverflow) += dvec3(ends[kOutcomeInterior]);
  lost(ledger, LossReason::kNumerical) += dvec3(ends[kOutcomeNumerical]);
}

}  // namespace

PhotonLedger::PhotonLedger(gpu::Device& device, std::uint32_t photons, std::uint32_t records)
    : device_(device),
      rows_pipeline_(device,
                     {.shader = shaders::ledger_rows_comp, .bindings = {{0}, {1}, {2}}, .push_bytes = sizeof(Push)},
                     "rows of the ledger"),
      sum_pipeline_(device, {.shader = shaders::ledger_sum_comp, .bindings = {{0}, {1}}, .push_bytes = sizeof(Push)},
                    "ledger"),
      account_(makeTable(device, std::uint64_t{photons} * sizeof(PhotonAccount), "accounts of photons")),
      rows_(makeTable(device, std::uint64_t{gpu::groupsOf(photons, kLedgerRow)} * kLedgerKinds * sizeof(vec3),
                      "rows of the ledger")),
      sums_(makeTable(device, std::uint64_t{records} * kLedgerKinds * sizeof(vec3), "ledger")),
      most_records_(records) {}

void PhotonLedger::record(gpu::CommandRecorder& recorder, const PhotonBuffer& photons, std::uint32_t count,
                          std::uint32_t light, std::uint32_t branch) {
  NEPHROID_ASSERT_LT(records_.size(), std::size_t{most_records_});
  const gpu::Buffer& source = photons.chunks()[0].buffer;
  const std::uint32_t rows = gpu::groupsOf(count, kLedgerRow);
  NEPHROID_ASSERT_LE(std::uint64_t{rows} * kLedgerKinds * sizeof(vec3), rows_.size());
  recorder.pass(
      "rows of the ledger",
      {Use(source, Access::kComputeRead), Use(account_, Access::kComputeRead), Use(rows_, Access::kComputeWrite)},
      [&](PassCommands& commands) {
        commands.bind(rows_pipeline_);
        commands.bindResources({Bound(0, source), Bound(1, account_), Bound(2, rows_)});
        commands.pushConstants(Push{count, rows});
        commands.dispatch(gpu::groupsOf(rows, kRowGroup));
      });
  const auto record = static_cast<std::uint32_t>(records_.size());
  recorder.pass("ledger", {Use(rows_, Access::kComputeRead), Use(sums_, Access::kComputeWrite)},
                [&](PassCommands& commands) {
                  commands.bind(sum_pipeline_);
                  commands.bindResources({Bound(0, rows_), Bound(1, sums_)});
                  commands.pushConstants(Push{rows, record});
                  commands.dispatch(1);
                });
  records_.push_back({light, branch == 0 ? count : 0});
}

Ledger PhotonLedger::read(std::uint32_t light) const {
  const std::vector<vec3> sums = gpu::readBackAs<vec3>(device_, sums_);
  Ledger ledger;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    if (records_[i].light != light) continue;
    ledger.emitted_count += records_[i].emitted_count;
    addSums(ledger, std::span(sums).subspan(i * kLedgerKinds, kLedgerKinds));
  }
  return ledger;
}

}  // namespace nephroid
