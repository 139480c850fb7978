#include "app/suites/bench/bench.h"

#include "app/suites/bench/accuracy.h"
#include "app/suites/bench/compare.h"
#include "app/suites/bench/paper.h"
#include "app/suites/bench/quick.h"
#include "app/suites/bench/scaling.h"
#include "app/suites/bench/solver.h"
#include "app/suites/bench/stability.h"
#include "app/suites/bench/validation.h"
#include "sim/files/error.h"
#include "sim/files/text.h"

namespace icloth {

int run_bench(const BenchOptions& options) {
  if (!options.other.empty() && options.suite != "compare")
    throw InputError("bench " + options.suite + ": " + in_quotes(options.other) +
                     " is one argument too many");
  if (options.suite == "quick") return run_quick(options);
  if (options.suite == "paper") return run_paper(options);
  if (options.suite == "compare") return run_compare(options);
  if (options.suite == "scaling") return run_scaling(options);
  if (options.suite == "accuracy") return run_accuracy(options);
  if (options.suite == "stability") return run_stability(options);
  if (options.suite == "validation") return run_validation(options);
  if (options.suite == "solver") return run_solver(options);
  throw InputError(
      "bench: suite " + in_quotes(options.suite) +
      ", expected quick, paper, scaling, accuracy, stability, validation, solver or compare");
}

}  // namespace icloth
