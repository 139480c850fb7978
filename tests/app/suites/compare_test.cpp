// Two programs on the same stretches: what is read of their statistics, and a whole comparison of
// the program with itself.
#include "app/suites/bench/compare.h"

#include <gtest/gtest.h>

#include "sim/files/error.h"
#include "tests/app/cli/program.h"

namespace icloth::testing {
namespace {

constexpr const char* kCsv =
    "step,time,ms_total,ms_ccd,state_hash,limits\n"
    "7,0.08,100,50,aaaa,\n"
    "8,0.09,3,1,bbbb,\n"
    "9,0.10,5,2.5,cccc,travel\n";

TEST(Compare, ReadsTheStepsOfTheStretch) {
  const StretchStatistics read = read_stretch(kCsv, "a.csv", 8);
  EXPECT_EQ(read.sum("ms_total"), 8);
  EXPECT_EQ(read.sum("ms_ccd"), 3.5);
  EXPECT_EQ(read.sum("ms_implicit"), 0);
  EXPECT_EQ(read.end_hash, "cccc");
}

TEST(Compare, RefusesFilesThatAreNoStatistics) {
  const auto refusal = [](const std::string& csv, long first) -> std::string {
    try {
      read_stretch(csv, "a.csv", first);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_TRUE(contains(refusal("", 0), "a.csv: line 1"));
  EXPECT_TRUE(contains(refusal("a,b\n1,2\n", 0), "a.csv: line 1"));
  EXPECT_TRUE(
      contains(refusal("step,ms_total\n1,2,3\n", 0), "a.csv: line 2: 3 fields, expected 2"));
  EXPECT_TRUE(contains(refusal(kCsv, 10), "no row from step 10 on"));
}

TEST(Compare, SpreadsHaveTheirMiddleAndTheirEnds) {
  const Spread odd = spread_of({3, 1, 2}), even = spread_of({4, 1, 2, 3});
  EXPECT_EQ(odd.median, 2);
  EXPECT_EQ(odd.least, 1);
  EXPECT_EQ(odd.most, 3);
  EXPECT_EQ(even.median, 2.5);
}

class CompareRun : public Cli {};

TEST_F(CompareRun, AProgramEndsWhereItselfEnds) {
  const Outcome outcome =
      icloth(std::string("bench compare '") + ICLOTH_PROGRAM +
             "' --scale 0.001 --case funnel --repeat 1 --threads 1 --quiet --out here");
  ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  const std::string table = read(folder_ / "here/compare.csv");
  EXPECT_EQ(count_lines(table), 3u) << "a quick look at two stretches\n" << table;
  EXPECT_EQ(table.find("no\n"), std::string::npos) << table;
  EXPECT_TRUE(contains(table, ",yes\n")) << table;
}

TEST_F(CompareRun, ProgramsThatAreNoneAreRefused) {
  expect_bad_input("bench compare", "no program");
  expect_bad_input("bench compare nowhere/icloth", "nowhere/icloth");
  expect_bad_input("bench quick nowhere/icloth", "one argument too many");
  const Outcome outcome = icloth("bench compare /bin/false --scale 0.001 --case funnel --quiet");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(contains(outcome.err, "/bin/false run funnel")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "ended with 1")) << outcome.err;
}

}  // namespace
}  // namespace icloth::testing
