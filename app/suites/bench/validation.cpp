#include "app/suites/bench/validation.h"

#include <cstdio>

#include "app/suites/bench/suite.h"
#include "app/suites/validation/case_run.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"

namespace icloth {
namespace {

using Json = nlohmann::ordered_json;
using validation::Case;
using validation::CaseResult;
using validation::Comparison;

/// Prints the comparisons of a case, and the requirements that it missed below them.
void print_case(const Case& test, Build build, const CaseResult& r) {
  for (const Comparison& f : r.comparisons)
    std::printf("%-19s %-6s %-50s %12.6g %12.6g %9.1e %8.1e  %s\n", test.name,
                std::string(build_name(build)).c_str(), f.what.c_str(), f.reference, f.measured,
                f.error, f.target, f.passed() ? "ok" : "FAIL");
  for (const std::string& failure : r.failures) std::printf("    required: %s\n", failure.c_str());
  std::fflush(stdout);
}

/// The result of a case as JSON.
Json describe(const Case& test, Build build, const CaseResult& r) {
  Json json;
  json["name"] = test.name;
  json["source"] = test.source;
  json["build"] = build_name(build);

  json["steps"] = r.steps;
  json["seconds"] = r.seconds;

  json["passed"] = r.passed();
  json["failures"] = r.failures;

  // Each comparison is an object of its own.
  json["figures"] = Json::array();
  for (const Comparison& f : r.comparisons)
    json["figures"].push_back({{"what", f.what},
                               {"reference", f.reference},
                               {"measured", f.measured},
                               {"error", f.error},
                               {"absolute", f.absolute},
                               {"target", f.target},
                               {"passed", f.passed()}});
  return json;
}

/// The result of a case as rows of figures.csv.
std::string csv_rows(const Case& test, Build build, const CaseResult& r) {
  std::string rows;
  char numbers[160];
  for (const Comparison& f : r.comparisons) {
    std::snprintf(numbers, sizeof numbers, ",%.9g,%.9g,%.3e,%.3e,%s\n", f.reference, f.measured,
                  f.error, f.target, f.passed() ? "ok" : "FAIL");
    rows += std::string(test.name) + "," + std::string(build_name(build)) + ",\"" + f.what + "\"" +
            numbers;
  }
  return rows;
}

}  // namespace

int run_validation(const BenchOptions& options) {
  const std::vector<Build> builds = chosen_builds(options.device);
  Json results = begin_suite(options, builds);
  std::string csv = "case,build,what,reference,measured,error,target,verdict\n";

  std::printf("%-19s %-6s %-50s %12s %12s %9s %8s  %s\n", "case", "build", "what", "reference",
              "measured", "error", "target", "verdict");
  int cases = 0, failed = 0;
  double seconds = 0;

  // Every case that --case leaves in runs on every build that can hold it to its targets.
  for (const Case& test : validation::cases()) {
    if (!chosen(options, test.name)) continue;
    for (const Build build : builds) {
      validation::Settings settings;
      settings.build = build;

      if (!runs_on(test, settings.build)) continue;
      const CaseResult result = run_case(test, settings);
      ++cases;
      failed += result.passed() ? 0 : 1;
      seconds += result.seconds;

      print_case(test, settings.build, result);
      results["results"].push_back(describe(test, settings.build, result));
      csv += csv_rows(test, settings.build, result);
    }
  }

  // The verdict is printed; the files are for the documentation.
  if (cases == 0) throw no_such_case(options);
  std::printf("%d of %d cases within their targets, %.1f s\n", cases - failed, cases, seconds);
  if (!options.out.empty()) {
    write_file(options.out + "/results.json", results.dump(1) + "\n");
    write_file(options.out + "/figures.csv", csv);
  }
  return failed == 0 ? 0 : 1;
}

}  // namespace icloth
