// icloth-bench, the program of the benchmark suites; `icloth bench` starts it.
#include "app/common/command_options.h"
#include "app/common/program.h"
#include "app/suites/bench/bench.h"
#include "sim/files/body_io.h"
#include "sim/files/error.h"

namespace icloth {
namespace {

/// The options of the suites, of which some belong to a few suites only.
void add_options(CLI::App& app, BenchOptions& bench) {
  app.add_option("SUITE", bench.suite,
                 "quick, paper, scaling, accuracy, stability, validation, solver or compare")
      ->capture_default_str();
  app.add_option("OTHER", bench.other, "compare: another icloth program");
  app.add_option("--out", bench.out, "folder of report.html, results.json and tables");
  add_device_option(app, bench.device);
  app.add_option("--threads", bench.threads, "threads of the CPU solver")
      ->check(CLI::Range(1, 4096));
  app.add_flag("--quiet", bench.quiet, "no progress line");

  // These options are for some of the suites only.
  app.add_option("--case", bench.only,
                 "accuracy, compare, paper, scaling, stability, validation, solver: only cases "
                 "whose name holds "
                 "this");
  app.add_option("--repeat", bench.repeat, "compare: turns of each program")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--scale", bench.scale,
                 "compare, paper, scaling: share of the number of triangles")
      ->check(CLI::Range(1e-3, 10.0))
      ->capture_default_str();
  app.add_flag("--continue", bench.go_on,
               "paper: goes on with the measurements that --out has already");
  app.add_option("--frames", bench.frames, "stability: folder for every 10th state as OBJ files");
  app.add_option("--soak", bench.soak, "stability: simulated seconds of random dragging")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str();
}

int run_suite(int argc, const char* const* argv) {
  CLI::App app{"icloth bench: benchmark suites and reports", "icloth bench"};
  BenchOptions options;
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    throw InputError(first_line(error.what()) + " (see icloth bench --help)");
  }
  return run_bench(options);
}

}  // namespace
}  // namespace icloth

int main(int argc, char** argv) {
  // A program that reads bodies runs itself again for it.
  if (const auto code = icloth::serve_body_reader(argc, argv)) return *code;
  return icloth::run_program([&] { return icloth::run_suite(argc, argv); });
}
