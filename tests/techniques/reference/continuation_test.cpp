// Which parts of paths are followed how often.
#include "techniques/reference/continuation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nephroid {
namespace {

PathClass makeEvents(std::initializer_list<EventClass> events) {
  PathClass path;
  for (const EventClass event : events) path.add(event);
  return path;
}
constexpr EventClass kS = EventClass::kSpecular, kD = EventClass::kDiffuse;

TEST(PathPart, CountsDiffuseEventsOfPathsThatBeginAtMirrorsAndGlass) {
  EXPECT_EQ(PathPart::of(makeEvents({})), 0U);
  EXPECT_EQ(PathPart::of(makeEvents({kD, kD, kS})), 0U);
  EXPECT_EQ(PathPart::of(makeEvents({kS, kS})), 0U);
  EXPECT_EQ(PathPart::of(makeEvents({kS, kD, kS})), 1U);
  EXPECT_EQ(PathPart::of(makeEvents({kS, kD, kS, kD})), 2U);
  EXPECT_EQ(PathPart::of(makeEvents({kS, kD, kD, kD, kD, kD, kD})), PathPart::kCount - 1);
}

TEST(Continuation, FollowsWhatBringsNothingSeldom) {
  // Half of the rays are beyond the first diffuse event, for nothing.
  const PartTally tally{.squares = {900, 0, 0, 0, 0}, .rays = {1000, 800, 200, 0, 0}};
  const Continuation continuation = chooseContinuation(tally, 500.0);
  EXPECT_EQ(continuation.probability[0], 1.0F);
  EXPECT_FLOAT_EQ(continuation.probability[1], 0.5F);
  // Those who are there are few enough.
  for (const std::size_t part : {2U, 3U, 4U}) EXPECT_EQ(continuation.probability[part], 1.0F) << part;
}

TEST(Continuation, FollowsWhatBringsMuchAlways) {
  const PartTally tally{.squares = {900, 200, 100, 50, 20}, .rays = {1000, 400, 200, 100, 10}};
  for (const float p : chooseContinuation(tally, 500.0).probability) EXPECT_EQ(p, 1.0F);
}

TEST(Continuation, IsTwiceTheBestRateBetween) {
  // Beyond the first event: 0.0225 of the variance for 1/4 of the rays: √(0.0225/0.25) = 0.3. Beyond the second
  // 0.002916 for 4/100: 0.27, which is 0.9 of those that got so far.
  const PartTally tally{.squares = {900, 19.584, 2.916, 0, 0}, .rays = {750, 210, 40, 0, 0}};
  const Continuation continuation = chooseContinuation(tally, 1000.0);
  EXPECT_NEAR(continuation.probability[1], 0.6F, 1e-6F);
  EXPECT_NEAR(continuation.probability[2], 0.9F, 1e-6F);
  EXPECT_EQ(continuation.into(makeEvents({kS, kD})), continuation.probability[1]);
  EXPECT_EQ(continuation.into(makeEvents({kD})), 1.0F);
}

TEST(Continuation, FollowsLesserWaysAsOftenAsTheyPay) {
  // A quarter of the rays for 9/10 000 of the variance: √(0.0009/0.25) = 0.06, of which eight times.
  PartTally tally{.squares = {900, 90, 9, 0, 0}, .rays = {800, 150, 50, 0, 0}};
  EXPECT_EQ(chooseContinuation(tally, 1000.0).lesser_way, 1.0F);
  tally.lesser_rays = 250.0, tally.lesser_squares = 0.9;
  EXPECT_NEAR(chooseContinuation(tally, 1000.0).lesser_way, 0.48F, 1e-6F);
  tally.lesser_squares = 0.0;
  EXPECT_EQ(chooseContinuation(tally, 1000.0).lesser_way, 0.25F);
  tally.lesser_squares = 90.0;
  EXPECT_EQ(chooseContinuation(tally, 1000.0).lesser_way, 1.0F);
}

TEST(Continuation, OfNothingMeasuredIsToGoOn) {
  const Continuation continuation = chooseContinuation({}, 0.0);
  for (const float p : continuation.probability) EXPECT_EQ(p, 1.0F);
  EXPECT_EQ(continuation.lesser_way, 1.0F);
}

}  // namespace
}  // namespace nephroid
