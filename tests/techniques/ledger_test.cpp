#include "techniques/ledger.h"

#include <gtest/gtest.h>

namespace nephroid {
namespace {

Ledger makeLedger() {
  Ledger ledger;
  ledger.light = "sun";
  ledger.emitted_count = 10;
  ledger.emitted = dvec3(10.0);
  ledger.missed = dvec3(1.0);
  ledger.blocked = dvec3(2.0);
  ledger.absorbed = dvec3(0.5);
  ledger.escaped = dvec3(1.5);
  ledger.deposited = dvec3(4.0);
  ledger.lost[0] = dvec3(1.0);
  return ledger;
}

TEST(Ledger, ClosesWhenEverythingIsAccountedFor) { EXPECT_LE(makeLedger().residual(), 1e-15); }

TEST(Ledger, ResidualNamesWhatIsMissingOfTheWorstChannel) {
  Ledger ledger = makeLedger();
  ledger.deposited.y -= 0.25;
  EXPECT_NEAR(ledger.residual(), 0.025, 1e-12);
}

TEST(Ledger, SumsAndScales) {
  Ledger ledger = makeLedger();
  ledger.add(makeLedger());
  ledger.scale(0.5);
  EXPECT_EQ(ledger.emitted_count, 20U);
  EXPECT_DOUBLE_EQ(ledger.deposited.x, 4.0);
  EXPECT_DOUBLE_EQ(ledger.lost[0].z, 1.0);
}

TEST(DiagnoseLedgers, SaysWhereTheLightWent) {
  Ledger ledger = makeLedger();
  ledger.deposited = dvec3(0.0);
  ledger.escaped = dvec3(5.5);
  const auto sentences = diagnoseLedgers({ledger});
  ASSERT_FALSE(sentences.empty());
  bool names_escape = false;
  for (const std::string& s : sentences) names_escape = names_escape || s.find("leaves the scene") != std::string::npos;
  EXPECT_TRUE(names_escape);
  EXPECT_TRUE(diagnoseLedgers({makeLedger()}).empty());
  EXPECT_EQ(diagnoseLedgers({}).size(), 1U);
}

TEST(FormatLedgers, ShowsEveryLineThatIsNotZero) {
  const std::string text = formatLedgers({makeLedger()});
  for (const char* part : {"sun", "missed", "blocked", "deposited", "bounce limit", "closes"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  EXPECT_NE(formatLedgersJson({makeLedger()}).find("\"residual\""), std::string::npos);
}

}  // namespace
}  // namespace nephroid
