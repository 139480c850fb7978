#include "app/suites/bench/stability.h"

#include <cstdio>

#include "app/common/machine.h"
#include "app/suites/bench/suite.h"
#include "app/suites/stability/case_run.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"

namespace icloth {
namespace {

using Json = nlohmann::ordered_json;
using stability::Case;
using stability::CaseResult;

void print_head() {
  std::printf("%-21s %-6s %6s %8s %7s %7s %8s %9s %8s %7s %6s %5s %4s %6s  %s\n", "case", "build",
              "steps", "substeps", "retries", "rounds", "impacts", "violation", "strain", "refused",
              "states", "penet", "NaN", "s", "verdict");
}

/// Prints the row of a case, and the requirements that it missed below it.
void print_row(const Case& test, Build build, const CaseResult& r) {
  const auto number = [](std::int64_t n) { return static_cast<long long>(n); };
  std::printf(
      "%-21s %-6s %6lld %8lld %7lld %7lld %8lld %9.1e %8.3f %7lld %6lld %5lld %4s %6.1f  %s\n",
      test.name, std::string(build_name(build)).c_str(), number(r.steps), number(r.substeps),
      number(r.retries), number(r.rounds), number(r.impacts), r.violation, r.max_strain,
      number(r.refused), number(r.states), number(r.penetrations), r.finite ? "no" : "yes",
      r.seconds, r.passed() ? "pass" : "FAIL");
  for (const std::string& failure : r.failures) std::printf("    required: %s\n", failure.c_str());
  std::fflush(stdout);
}

/// The result of a case as JSON.
Json describe(const Case& test, Build build, const CaseResult& r) {
  Json json;
  json["name"] = test.name;
  json["required"] = test.required;
  json["build"] = build_name(build);

  // The work and the extremes of the case.
  json["steps"] = r.steps;
  json["substeps"] = r.substeps;
  json["retries"] = r.retries;
  json["rounds"] = r.rounds;
  json["impacts"] = r.impacts;
  json["zone_violation"] = r.violation;
  json["max_strain"] = r.max_strain;
  json["max_speed"] = r.max_speed;
  json["refused_steps"] = r.refused;
  json["states_checked"] = r.states;
  json["penetrations"] = r.penetrations;
  json["finite"] = r.finite;
  json["seconds"] = r.seconds;

  // The verdict tells which requirements were missed.
  json["passed"] = r.passed();
  json["failures"] = r.failures;
  json["note"] = r.note;
  return json;
}

}  // namespace

int run_stability(const BenchOptions& options) {
  const std::vector<Build> builds = chosen_builds(options.device);
  Json results = begin_suite(options, builds);

  // The settings are common to all cases; only the build changes.
  stability::Settings settings;
  settings.threads = options.threads;
  settings.soak_seconds = options.soak;
  make_output_folder(options.frames, "--frames");
  settings.frames = options.frames;

  print_head();

  // Every case that --case leaves in runs on every build.
  int failed = 0, passed = 0;
  for (const Case& test : stability::cases()) {
    if (!chosen(options, test.name)) continue;
    for (const Build build : builds) {
      settings.build = build;
      const CaseResult result = run_case(test, settings);
      ++(result.passed() ? passed : failed);
      print_row(test, build, result);
      results["results"].push_back(describe(test, build, result));
    }
  }

  // The verdicts are counted; a --case that fits none is a mistake.
  if (passed + failed == 0) throw no_such_case(options);
  std::printf("%d passed, %d failed\n", passed, failed);
  if (!options.out.empty()) write_file(options.out + "/results.json", results.dump(1) + "\n");
  return failed == 0 ? 0 : 1;
}

}  // namespace icloth
