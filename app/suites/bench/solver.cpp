#include "app/suites/bench/solver.h"

#include <algorithm>
#include <array>

#include "app/suites/bench/frames.h"
#include "app/suites/bench/suite.h"
#include "app/suites/report/report.h"
#include "kernels/parallel/profile.h"
#include "sim/files/error.h"

namespace icloth {
namespace {

/// A run whose states serve for the comparison.
struct SolverCase {
  const char* name;
  const char* scene;
  std::vector<std::string> overrides;
  long first, last, every;
};

// In the sphere scene the sheets hang at first and lie on the ball from step 90 on.
const SolverCase kCases[] = {
    {"sphere 200K", "sphere", {"triangles=200000"}, 10, 111, 50},
    {"scarf 10K", "scarf", {"triangles=10000"}, 40, 101, 30},
    {"sphere 10K, 1/100 s, 10 x stiffer",
     "sphere",
     {"triangles=10000", "step.time_step=0.01", "material.stretch_scale=10"},
     10,
     71,
     30},
};

constexpr std::pair<Preconditioner, const char*> kPreconditioners[] = {
    {Preconditioner::block_jacobi, "block_jacobi"}, {Preconditioner::multilevel, "multilevel"}};

/// The time and the iterations of the solves of one step, or of several.
struct Measured {
  double ms_solve = 0, ms_set_up = 0;
  std::int64_t solves = 0, iterations = 0;
  std::int64_t contacts = 0;  ///< the most
  double residual = 0;        ///< the largest

  double ms() const { return ms_solve + ms_set_up; }
  void add(const Measured& m) {
    ms_solve += m.ms_solve, ms_set_up += m.ms_set_up;
    solves += m.solves, iterations += m.iterations;
    contacts = std::max(contacts, m.contacts);
    residual = std::max(residual, m.residual);
  }
};
using Compared = std::array<Measured, std::size(kPreconditioners)>;

/// Measures a step. With `first_solve` it makes no more than the first solve of each substep, which
/// starts from zero.
Measured measure(Frames& frames, const Snapshot& state, Preconditioner preconditioner,
                 bool first_solve) {
  Measured measured;
  profile_reset();
  profile_enable(true);

  // Both preconditioners solve to the same residual, with room to get there.
  const StepReport report = frames.step(state, [&](Parameters& p) {
    p.implicit.preconditioner = preconditioner;
    p.implicit.cg_tolerance = 1e-3;
    p.implicit.cg_max_iterations = 5000;
    if (first_solve) p.implicit.newton_iterations = p.implicit.contact_passes = 1;
  });
  profile_enable(false);

  // The report has the counts; the profile has the times of the solves and of the set-up.
  measured.solves = report.linear_solves;
  measured.iterations = report.cg_iterations;
  measured.contacts = report.proximity_pairs;
  measured.residual = report.cg_residual;
  for (const ProfileRow& row : profile_rows()) {
    if (row.name == "implicit.solve") measured.ms_solve += row.ms;
    if (row.name.starts_with("implicit.coarse")) measured.ms_set_up += row.ms;
  }
  return measured;
}

/// Measures all preconditioners in turns, as the speed of a machine that others use comes and goes.
/// The fastest run of each counts.
Compared compare(Frames& frames, const Snapshot& state, bool first_solve) {
  constexpr int kRepeats = 5;
  Compared fastest;
  for (int k = 0; k < kRepeats; ++k) {
    for (std::size_t p = 0; p < fastest.size(); ++p) {
      const Measured now = measure(frames, state, kPreconditioners[p].first, first_solve);
      if (k == 0 || now.ms() < fastest[p].ms()) fastest[p] = now;
    }
  }
  return fastest;
}

/// Adds one row for each preconditioner.
void add_rows(const char* scene, const std::string& step, const std::string& what,
              const Compared& compared, Table& table) {
  for (std::size_t p = 0; p < compared.size(); ++p) {
    const Measured& m = compared[p];
    const auto solves = static_cast<double>(std::max<std::int64_t>(m.solves, 1));
    table.add({scene, step, std::to_string(m.contacts), what, kPreconditioners[p].second,
               format_number(solves), format_number(static_cast<double>(m.iterations) / solves),
               format_number(m.residual, 3), format_number(m.ms_solve), format_number(m.ms_set_up),
               format_number(compared[0].ms() / m.ms(), 3)});
  }
}

/// Compares on every state of a case, and on all of them together.
void run_case(const SolverCase& test, Build build, Table& table) {
  Frames frames(build, test.scene, test.overrides, test.first, test.last, test.every);
  for (const bool first_solve : {true, false}) {
    const std::string what = first_solve ? "first solve" : "step";
    Compared all;
    for (const Snapshot& state : frames.states()) {
      const Compared compared = compare(frames, state, first_solve);
      for (std::size_t p = 0; p < all.size(); ++p) all[p].add(compared[p]);
      add_rows(test.name, std::to_string(state.step), what, compared, table);
    }
    add_rows(test.name, "all", what, all, table);
  }
}

}  // namespace

int run_solver(const BenchOptions& options) {
  const Build build = only_build(options);
  Report report = begin_report(options, build);
  Table table("preconditioners", "Solves from the same states",
              {"scene", "step", "contacts", "what", "preconditioner", "solves",
               "iterations a solve", "residual", "ms solve", "ms set-up", "times faster"});

  // Every case adds its rows to one table.
  for (const SolverCase& test : kCases) {
    if (chosen(options, test.name)) run_case(test, build, table);
  }

  if (table.rows().empty()) throw no_such_case(options);

  // The report explains the columns before it shows them.
  report.heading("Preconditioners of the implicit step");
  report.text(
      "From the same states one step is taken with each preconditioner, to a relative residual of "
      "1e-3: the first solve of each substep alone, which starts from zero, and all of them, which "
      "start from the one before. Times are sums over the solves of the step; the set-up is what "
      "the preconditioner needs for every system; all: the sum over the states; faster: "
      "block-Jacobi's time divided by the row's.");
  report.add(table);
  finish_report(options, report);
  return 0;
}

}  // namespace icloth
