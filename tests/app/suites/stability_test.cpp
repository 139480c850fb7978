// The hard cases of `icloth bench stability` in their shortest form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "app/suites/stability/case_run.h"

namespace icloth::stability {
namespace {

std::vector<const Case*> all_cases() {
  std::vector<const Case*> list;
  for (const Case& test : cases()) list.push_back(&test);
  return list;
}

using Parameter = std::tuple<const Case*, Build>;

class Stability : public ::testing::TestWithParam<Parameter> {};

std::string test_name(const ::testing::TestParamInfo<Parameter>& info) {
  std::string name;
  for (const char c : std::string_view(std::get<0>(info.param)->name))
    name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name + "_" + std::string(build_name(std::get<1>(info.param)));
}

INSTANTIATE_TEST_SUITE_P(Cases, Stability,
                         ::testing::Combine(::testing::ValuesIn(all_cases()),
                                            ::testing::Values(Build::cpu32, Build::cuda32)),
                         test_name);

TEST_P(Stability, IsAsRequired) {
  const auto& [test, build] = GetParam();
  std::string reason;
  if (!build_available(build, &reason)) GTEST_SKIP() << reason;
  Settings settings;
  settings.build = build;
  settings.brief = true;
  const CaseResult result = run_case(*test, settings);
  EXPECT_EQ(result.penetrations, 0);
  EXPECT_TRUE(result.finite);
  for (const std::string& failure : result.failures) ADD_FAILURE() << "required: " << failure;
  RecordProperty("seconds", std::to_string(result.seconds));
}

/// The suite must be able to fail.
void cross(CaseRun& run) { run.require(1 > 2, "one above two"); }
void crash(CaseRun&) { throw std::runtime_error("broken"); }

TEST(StabilitySuite, NamesWhatIsNotAsRequired) {
  const CaseResult crossed = run_case({"cross", "", cross}, {});
  ASSERT_EQ(crossed.failures.size(), 1u);
  EXPECT_EQ(crossed.failures[0], "one above two");
  const CaseResult crashed = run_case({"crash", "", crash}, {});
  ASSERT_EQ(crashed.failures.size(), 1u);
  EXPECT_NE(crashed.failures[0].find("broken"), std::string::npos);
}

TEST(StabilitySuite, NamesAreDifferent) {
  std::vector<std::string> names;
  for (const Case& test : cases()) names.emplace_back(test.name);
  std::ranges::sort(names);
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

}  // namespace
}  // namespace icloth::stability
