// The reports that the window keeps, and what it says of slow steps.
#include "app/window/panels/stage_history.h"

#include <gtest/gtest.h>

namespace icloth {
namespace {

/// Five milliseconds, of which four are the solver's, with a hundred iterations.
StepReport usual(std::int64_t step) {
  StepReport report;
  report.step = step;
  report.ms_total = 5;
  report.ms_implicit = 4;
  report.ms_ccd = 1;
  report.cg_iterations = 100;
  report.elementary_tests = 1000;
  return report;
}

StepReport slow(std::int64_t step, double ms) {
  StepReport report = usual(step);
  report.ms_total = ms;
  report.ms_implicit = ms - 1;
  report.cg_iterations = 300;
  return report;
}

std::vector<std::int64_t> slowest(const StageHistory& history) {
  std::vector<std::int64_t> steps;
  for (const StepReport& report : history.slowest()) steps.push_back(report.step);
  return steps;
}

TEST(StageHistory, KeepsTheSlowestStepsOfTheWholeRun) {
  StageHistory history;
  for (std::int64_t step = 1; step <= 1000; ++step)
    history.add({step % 100 == 0 ? slow(step, 10 + static_cast<double>(step)) : usual(step)});
  EXPECT_EQ(history.reports().size(), StageHistory::kLength);
  EXPECT_EQ(slowest(history), (std::vector<std::int64_t>{1000, 900, 800, 700, 600}));
}

TEST(StageHistory, ForgetsTheStepsThatWereTakenBack) {
  StageHistory history;
  for (std::int64_t step = 1; step <= 10; ++step)
    history.add({slow(step, static_cast<double>(step))});
  history.cut(8);
  EXPECT_EQ(history.newest()->step, 8);
  EXPECT_EQ(slowest(history), (std::vector<std::int64_t>{8, 7, 6}));

  // A step that is made again takes the place of what it was before.
  history.add({slow(7, 100)});
  EXPECT_EQ(history.newest()->step, 7);
  EXPECT_EQ(slowest(history), (std::vector<std::int64_t>{7, 6}));
}

TEST(StageHistory, TellsWhatASlowStepHadMoreOf) {
  StageHistory history;
  for (std::int64_t step = 1; step <= 99; ++step) history.add({usual(step)});
  history.add({slow(100, 20)});
  EXPECT_EQ(why_slow(*history.newest(), history), "300 CG iterations, usually 102");

  StepReport report = usual(101);
  report.ms_ccd = 30;
  report.elementary_tests = 50000;
  history.add({report});
  EXPECT_EQ(why_slow(report, history), "50000 elementary tests, usually 1485");

  // A step that only took longer had no more to do.
  StepReport waited = usual(102);
  waited.ms_implicit = 60;
  EXPECT_EQ(why_slow(waited, history), "no more work than usual: the machine was busy");

  report.substeps = 4;
  EXPECT_EQ(why_slow(report, history), "4 substeps for fast cloth");
  report.retries = 2;
  EXPECT_EQ(why_slow(report, history), "2 retries with half the step");
  EXPECT_FALSE(why_slow(report, StageHistory()).empty());
}

}  // namespace
}  // namespace icloth
