#include "sim/substep_clock.h"

#include <gtest/gtest.h>

#include <vector>

namespace icloth {
namespace {

/// Lengths of the substeps until the step is done. An attempt is refused where the list says so.
std::vector<double> lengths(SubstepClock clock, const std::vector<bool>& refused, int least_level) {
  std::vector<double> list;
  for (std::size_t attempt = 0; !clock.is_done(); ++attempt) {
    if (attempt < refused.size() && refused[attempt]) {
      EXPECT_TRUE(clock.halve());
    } else {
      list.push_back(clock.length());
      clock.advance(least_level);
    }
  }
  return list;
}

TEST(SubstepClock, AStepThatNothingRefusesIsOneSubstep) {
  EXPECT_EQ(lengths({3, 1, 4, 0}, {}, 0), std::vector<double>{1});
}

TEST(SubstepClock, SubstepsGrowAgainOnlyWhereALongerOneCanStart) {
  // Substeps start at multiples of their lengths, and each is at most twice as long as the last.
  EXPECT_EQ(lengths({0, 1, 4, 0}, {true, true, true}, 0),
            (std::vector<double>{0.125, 0.125, 0.25, 0.5}));
  EXPECT_EQ(lengths({0, 1, 4, 2}, {false, true}, 0),
            (std::vector<double>{0.25, 0.125, 0.125, 0.25, 0.25}));
}

TEST(SubstepClock, SubstepsStayAsShortAsTheSpeedAsksFor) {
  EXPECT_EQ(lengths({0, 1, 4, 2}, {}, 2), (std::vector<double>{0.25, 0.25, 0.25, 0.25}));
}

TEST(SubstepClock, SubstepsFollowEachOtherWithoutAGapAndEndWithTheStep) {
  // A third is no binary fraction, so sums of lengths would be rounded.
  const double time = 7, dt = 1.0 / 3;
  SubstepClock clock(time, dt, 6, 0);
  double end = time;
  for (int attempt = 0; !clock.is_done(); ++attempt) {
    EXPECT_NEAR(clock.start(), end, 1e-14);
    if (attempt % 3 == 0 && clock.halve()) continue;
    end = clock.start() + clock.length();
    clock.advance(0);
  }
  EXPECT_NEAR(end, time + dt, 1e-14);
  EXPECT_EQ(clock.start(), time + dt);
}

TEST(SubstepClock, TheShortestSubstepIsNotHalved) {
  SubstepClock clock(0, 1, 2, 0);
  EXPECT_FALSE(clock.is_shortest());
  EXPECT_TRUE(clock.halve());
  EXPECT_TRUE(clock.halve());
  EXPECT_TRUE(clock.is_shortest());
  EXPECT_FALSE(clock.halve());
  EXPECT_EQ(clock.length(), 0.25);
}

}  // namespace
}  // namespace icloth
