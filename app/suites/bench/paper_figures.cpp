#include "app/suites/bench/paper_figures.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace icloth {
namespace {

using Json = PaperStore::Json;

/// A column of one way over all stretches of a scene, one after the other, of as many steps as
/// another way has made.
std::vector<double> over_stretches(const PaperResults& results, const PaperScene& scene,
                                   const std::string& mode, const char* column,
                                   const std::string& same_as) {
  std::vector<double> values;
  for (const Stretch& stretch : scene.stretches) {
    const Json* result = results.find(scene, stretch, mode);
    const Json* other = results.find(scene, stretch, same_as);
    if (!result || !other) continue;
    std::vector<double> here = column_of(result->at("rows"), column);
    here.resize(std::min(here.size(), rows_of(other->at("rows"))));
    values.insert(values.end(), here.begin(), here.end());
  }
  return values;
}

/// The rows of two ways on one stretch, and the number of steps that both have made.
struct PairedRows {
  const Stretch& stretch;
  const Json &a, &b;
  std::size_t count;
};

/// The stretches of a scene that two ways have been measured on.
std::vector<PairedRows> paired_rows(const PaperResults& results, const PaperScene& scene,
                                    const std::string& mode_a, const std::string& mode_b) {
  std::vector<PairedRows> pairs;
  for (const Stretch& stretch : scene.stretches) {
    const Json* a = results.find(scene, stretch, mode_a);
    const Json* b = results.find(scene, stretch, mode_b);
    if (!a || !b) continue;
    const Json &rows_a = a->at("rows"), &rows_b = b->at("rows");
    pairs.push_back({stretch, rows_a, rows_b, std::min(rows_of(rows_a), rows_of(rows_b))});
  }
  return pairs;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

double most_of(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::ranges::max_element(values);
}

/// A series over the numbers of the steps, the first of which is `first`.
Series over_steps(std::string name, const std::vector<double>& values, long first) {
  Series series{std::move(name), {}};
  for (std::size_t k = 0; k < values.size(); ++k)
    series.points.emplace_back(static_cast<double>(first + 1) + static_cast<double>(k), values[k]);
  return series;
}

/// Series of one way, one for each stretch.
void add_series(const PaperResults& results, const PaperScene& scene, const std::string& mode,
                const char* column, const std::string& label, Plot& plot) {
  for (const Stretch& stretch : scene.stretches)
    if (const Json* result = results.find(scene, stretch, mode)) {
      std::string name = label + (label.empty() ? "" : ", ");
      name += stretch_text(stretch);
      plot.series.push_back(
          over_steps(std::move(name), column_of(result->at("rows"), column), stretch.first));
    }
}

/// Fig. 5: time and iterations of every step, in (a, b) of Andy and in (c, d) of Funnel.
void show_convergence(const PaperResults& results, const PaperScene& scene, const char* parts,
                      Report& report) {
  report.heading(std::string(scene.title) + ": time and rounds of every step (Fig. 5" + parts +
                 ")");
  report.text(
      "The paper shows that the time of its solver follows the number of iterations, and that most "
      "frames need fewer than 10. Our default solver goes nearer to the optimum of each zone than "
      "the paper's method does, which decides how many rounds follow; times are those of a "
      "processor.");

  // A way is one row, over all steps that were made of it.
  Table table("fig5_" + std::string(scene.name), "Over the stretches",
              {"solver", "steps", "mean rounds", "most rounds", "steps with at most 10 rounds [%]",
               "mean iterations", "most iterations", "mean ms", "most ms"});
  // Our own way made more steps than the paper's method, so that there is a row of the same steps.
  const auto add_row = [&](const std::string& mode, const std::string& same_as, const char* label) {
    const auto rounds = over_stretches(results, scene, mode, "rounds", same_as);
    const auto iterations = over_stretches(results, scene, mode, "zone_iterations", same_as);
    const auto ms = over_stretches(results, scene, mode, "ms_impact_zones", same_as);
    if (rounds.empty()) return;
    const auto few = std::ranges::count_if(rounds, [](double r) { return r <= 10; });
    const double share = 100.0 * static_cast<double>(few) / static_cast<double>(rounds.size());

    // Means and extremes, as the plots of the paper show them.
    table.add({label, std::to_string(rounds.size()), format_number(mean_of(rounds), 3),
               format_number(most_of(rounds)), format_number(share, 3),
               format_number(mean_of(iterations)), format_number(most_of(iterations), 6),
               format_number(mean_of(ms)), format_number(most_of(ms))});
  };
  add_row(kOwnMode, kOwnMode, "dual (ours)");
  add_row(kOwnMode, "gradient", "dual (ours), the steps of the next row");
  add_row("gradient", "gradient", "augmented Lagrangian (the paper's)");
  report.add(table);

  // Time above, iterations below, as in the paper.
  Plot time{.title = "Time of the impact zones", .x_label = "step", .y_label = "ms", .series = {}};
  Plot rounds{.title = "Rounds", .x_label = "step", .y_label = "rounds", .series = {}};
  if (const Json* run = results.find_run(scene, scene.stretches[0]); run && !scene.is_garment()) {
    time.series.push_back(
        over_steps("whole run", column_of(run->at("rows"), "ms_impact_zones"), 0));
    rounds.series.push_back(over_steps("whole run", column_of(run->at("rows"), "rounds"), 0));
  }
  add_series(results, scene, kOwnMode, "ms_impact_zones", "", time);
  add_series(results, scene, kOwnMode, "rounds", "", rounds);
  report.add(time);
  report.add(rounds);
}

/// Fig. 6: iterations of gradient descent.
void show_gradient_iterations(const PaperResults& results, const PaperScene& scene,
                              Report& report) {
  report.heading("Andy: iterations of gradient descent (Fig. 6)");
  report.text(
      "The paper shows the iterations that its solver takes until the step length is below 1e-12. "
      "Ours is the same method (impact_zones.solver=augmented_lagrangian) with at most 100 "
      "iterations a zone and round, of which steps with many rounds add up.");

  // Iterations of a step are those of all zones and rounds together.
  const auto iterations = over_stretches(results, scene, "gradient", "zone_iterations", "gradient");
  const auto rounds = over_stretches(results, scene, "gradient", "rounds", "gradient");
  Table table("fig6", "Augmented Lagrangian, over the stretches",
              {"steps", "mean iterations a step", "most", "mean iterations a round"});
  table.add({std::to_string(iterations.size()), format_number(mean_of(iterations)),
             format_number(most_of(iterations), 6),
             format_number(mean_of(iterations) / std::max(mean_of(rounds), 1e-9))});
  report.add(table);
  Plot plot{.title = "Iterations of the augmented Lagrangian, all rounds",
            .x_label = "step",
            .y_label = "iterations",
            .series = {}};
  add_series(results, scene, "gradient", "zone_iterations", "", plot);
  report.add(plot);
}

/// Fig. 7: impacts over the rounds of one large step of Dress.
void show_large_steps(const PaperResults& results, const PaperScene& scene, Report& report) {
  report.heading("Dress: one large step (Fig. 7)");
  report.text(
      "The paper's solver leaves 1002 impacts after 200 iterations at 1/20 s, and resolves all "
      "after 57 at 1/50 s. Single attempts are made as the paper makes them: the whole step at "
      "once, with at most 200 rounds; icloth itself cuts a step into substeps before it gives up, "
      "and so resolves both. Its stretches are other moments of another dance.");
  constexpr std::pair<const char*, const char*> kWays[] = {
      {"gradient", "single attempt, augmented Lagrangian"},
      {"dual", "single attempt, dual"},
      {"whole", "as icloth makes it"}};
  Table table("fig7", "From the beginnings of the stretches",
              {"clip starts at [s]", "time step", "way", "impacts before", "rounds",
               "impacts after the last round", "substeps", "retries", "rolled back", "accepted"});

  // A plot is of one time step, from the stretch where the body is fastest.
  for (const int rate : {20, 50}) {
    Plot plot{.title = "Impacts over the rounds, 1/" + std::to_string(rate) + " s",
              .x_label = "round",
              .y_label = "impacts",
              .series = {}};
    for (const Stretch& stretch : scene.stretches) {
      for (const auto& [way, label] : kWays) {
        const Json* result =
            results.find(scene, stretch, std::string(way) + " 1/" + std::to_string(rate));
        if (!result) continue;
        const Json& rows = result->at("rows");
        const auto impacts = rows.at("impacts").at(0).get<std::vector<double>>();
        table.add({format_number(stretch.clip_start), "1/" + std::to_string(rate), label,
                   format_number(impacts.empty() ? 0 : impacts.front(), 9),
                   format_number(sum_of(rows, "rounds")),
                   format_number(impacts.empty() ? 0 : impacts.back(), 9),
                   format_number(sum_of(rows, "substeps")), format_number(sum_of(rows, "retries")),
                   format_number(sum_of(rows, "rolled_back")),
                   sum_of(rows, "refused") > 0 ? "no" : "yes"});
        if (&stretch == &scene.stretches.front())
          plot.series.push_back(over_steps(label, impacts, -1));
      }
    }
    report.add(plot);
  }
  report.add(table);
}

/// Fig. 9: box tests of full and of incremental detection.
void show_incremental(const PaperResults& results, const PaperScene& scene, Report& report) {
  report.heading("Andy: incremental detection (Fig. 9)");
  report.text(
      "The paper counts 3.68 times fewer box tests on a frame of four rounds. Both of our versions "
      "find the same impacts and end in the same bits. How much is saved depends on the number of "
      "rounds: in the full version each tests all boxes, in the incremental one the first at most, "
      "and none where the lists of the step before still hold (0 box tests).");
  Table table(
      "fig9", "Tests in all rounds of a step",
      {"clip starts at [s]", "step", "rounds", "box tests full", "incremental", "ratio",
       "elementary tests full", "incremental (elementary)", "ratio (elementary)", "same state"});

  // Both ways take the same steps, and must end each of them in the same bits.
  std::map<std::string, double> full_tests, incremental_tests;
  for (const PairedRows& pair :
       paired_rows(results, scene, "counted full", "counted incremental")) {
    const Stretch& stretch = pair.stretch;
    const Json &a = pair.a, &b = pair.b;

    // A row is one step.
    for (std::size_t k = 0; k < pair.count; ++k) {
      const auto value = [k](const Json& rows, const char* name) {
        return column_of(rows, name)[k];
      };
      const auto ratio = [&](const char* name) {
        const double less = value(b, name);
        return less > 0 ? format_number(value(a, name) / less, 3) : "–";
      };
      table.add({format_number(stretch.clip_start),
                 std::to_string(stretch.first + static_cast<long>(k) + 1),
                 format_number(value(a, "rounds")), format_number(value(a, "box_tests"), 10),
                 format_number(value(b, "box_tests"), 10), ratio("box_tests"),
                 format_number(value(a, "elementary_tests"), 10),
                 format_number(value(b, "elementary_tests"), 10), ratio("elementary_tests"),
                 a.at("hash").at(k) == b.at("hash").at(k) ? "yes" : "no"});
    }
    for (const char* name : {"box_tests", "elementary_tests"}) {
      full_tests[name] += sum_of(a, name);
      incremental_tests[name] += sum_of(b, name);
    }
  }
  report.add(table);

  // Over all steps the ratio does not depend on which step begins with new lists.
  Table sums("fig9_all", "Sums of all these steps", {"tests", "full", "incremental", "ratio"});
  for (const auto& [name, label] :
       {std::pair{"box_tests", "box tests"}, std::pair{"elementary_tests", "elementary tests"}})
    sums.add(
        {label, format_number(full_tests[name], 12), format_number(incremental_tests[name], 12),
         incremental_tests[name] > 0 ? format_number(full_tests[name] / incremental_tests[name], 3)
                                     : "–"});
  report.add(sums);
}

/// Fig. 10: collision handling of single steps of Funnel.
void show_collision_handling(const PaperResults& results, const PaperScene& scene, Report& report) {
  report.heading("Funnel: collision handling against the PSCC-style (Fig. 10)");
  report.text(
      "The paper shows its collision handling to be faster than PSCC's where the cloth tangles: on "
      "frame 1100 it takes 34 iterations and 2.86 ms against 174 and 12.82 ms for the zones alone. "
      "Ours and the PSCC-style start from the same states; the latter tests all pairs again in "
      "every round. Its times are of a processor, and of broad phase, CCD and zones together.");
  Table table("fig10", "Steps from the same states",
              {"steps", "ms ours", "ms PSCC-style", "ratio", "rounds ours", "rounds PSCC-style",
               "iterations ours", "iterations PSCC-style"});
  Plot plot{.title = "Collision handling",
            .x_label = "step",
            .y_label = "ms",
            .log_y = true,
            .markers = true,
            .series = {}};

  // The mean over the steps that both ways made from the beginning of each stretch.
  for (const PairedRows& pair : paired_rows(results, scene, kOwnMode, "pscc")) {
    const Stretch& stretch = pair.stretch;
    const Json &a = pair.a, &b = pair.b;
    const std::size_t count = pair.count;
    const auto n = static_cast<double>(count);
    const auto mean = [&](const Json& rows, const char* name) {
      return format_number(sum_of(rows, name, count) / n);
    };
    table.add({std::to_string(stretch.first) + "–" +
                   std::to_string(stretch.first + static_cast<long>(count)),
               format_number(collision_ms(a, count) / n), format_number(collision_ms(b, count) / n),
               format_number(collision_ms(b, count) / collision_ms(a, count), 3), mean(a, "rounds"),
               mean(b, "rounds"), mean(a, "zone_iterations"), mean(b, "zone_iterations")});

    // The time of every step, of broad phase, CCD and zones together.
    for (const auto& [rows, label] : {std::pair{&a, "ours, "}, std::pair{&b, "PSCC-style, "}}) {
      std::vector<double> ms;
      for (std::size_t k = 1; k <= rows_of(*rows); ++k)
        ms.push_back(collision_ms(*rows, k) - collision_ms(*rows, k - 1));
      plot.series.push_back(over_steps(label + stretch_text(stretch), ms, stretch.first));
    }
  }
  report.add(table);
  report.add(plot);
}

/// Fig. 11: Dress with three time steps.
void show_time_steps(const PaperResults& results, const PaperScene& scene, Report& report) {
  report.heading("Dress: larger time steps (Fig. 11)");
  report.text(
      "The paper gains 1.76 and 2.73 with steps of 2 and 4 times 1/200 s. All three start from the "
      "same states and cover the same time. What we gain depends on how often larger steps have to "
      "be cut into substeps, and on their linear systems, which need more iterations.");
  Table table("fig11", "Over the stretches",
              {"time step", "steps", "substeps a step", "rounds a step", "ms a step",
               "seconds a simulated second", "speed-up", "speed-up in the paper", "penetrations"});

  // A row sums up all stretches with one time step; the first is what the others are compared with.
  double slowest = 0;
  for (const auto& [rate, paper] :
       {std::pair{200, "1"}, std::pair{100, "1.76"}, std::pair{50, "2.73"}}) {
    const std::string mode = rate == scene.rate ? kOwnMode : "1/" + std::to_string(rate);
    double steps = 0, ms = 0, substeps = 0, rounds = 0, penetrations = 0;
    for (const Stretch& stretch : scene.stretches)
      if (const Json* result = results.find(scene, stretch, mode)) {
        const Json& rows = result->at("rows");
        steps += static_cast<double>(rows_of(rows));
        ms += sum_of(rows, "ms_total");
        substeps += sum_of(rows, "substeps");
        rounds += sum_of(rows, "rounds");
        penetrations += result->at("penetrations").get<double>();
      }
    if (steps == 0) continue;

    // A simulated second is as many steps as the rate says.
    const double seconds = 1e-3 * ms / steps * rate;
    if (slowest == 0) slowest = seconds;
    table.add({"1/" + std::to_string(rate), format_number(steps), format_number(substeps / steps),
               format_number(rounds / steps), format_number(ms / steps), format_number(seconds),
               format_number(slowest / seconds, 3), paper, format_number(penetrations)});
  }
  report.add(table);
}

/// Fig. 12: the stages of Andy.
void show_stages(const PaperResults& results, const PaperScene& scene, Report& report) {
  report.heading("Andy: stages against the PSCC-style (Fig. 12)");
  report.text(
      "The paper gains 3.25 on average and 6.6 at most on a frame, and its penetration handling is "
      "no longer the bottleneck. Only collision handling differs between our two ways; they share "
      "time integration, which takes a larger part of a step here than on a GPU.");
  constexpr std::pair<const char*, const char*> kStages[] = {
      {"ms_implicit", "time integration"}, {"ms_proximity", "proximity"},
      {"ms_broad_phase", "broad phase"},   {"ms_ccd", "narrow phase"},
      {"ms_impact_zones", "impact zones"}, {"ms_total", "whole step"}};
  Table table(
      "fig12", "Mean of the same steps",
      {"stage", "ms ours", "share [%]", "ms PSCC-style", "share [%] (PSCC-style)", "ratio"});

  // Sums over the steps that both ways made, and the largest gain of one step.
  std::vector<double> ours(std::size(kStages), 0), theirs(std::size(kStages), 0);
  double steps = 0, peak = 0;
  for (const PairedRows& pair : paired_rows(results, scene, kOwnMode, "pscc")) {
    const Json &a = pair.a, &b = pair.b;
    steps += static_cast<double>(pair.count);
    for (std::size_t k = 0; k < std::size(kStages); ++k) {
      ours[k] += sum_of(a, kStages[k].first, pair.count);
      theirs[k] += sum_of(b, kStages[k].first, pair.count);
    }
    for (std::size_t k = 0; k < pair.count; ++k)
      peak = std::max(peak, column_of(b, "ms_total")[k] / column_of(a, "ms_total")[k]);
  }
  if (steps == 0) return;

  // The last row is the whole step, of which the others are parts.
  for (std::size_t k = 0; k < std::size(kStages); ++k)
    table.add({kStages[k].second, format_number(ours[k] / steps),
               format_number(100 * ours[k] / ours.back(), 3), format_number(theirs[k] / steps),
               format_number(100 * theirs[k] / theirs.back(), 3),
               format_number(theirs[k] / std::max(ours[k], 1e-9), 3)});
  report.add(table);
  report.text("The largest gain of a single step is " + format_number(peak, 3) + ".");
}

}  // namespace

void show_single_attempts(const PaperResults& results, Report& report) {
  if (results.scenes.empty()) return;
  report.heading("Solvers of impact zones in a single attempt (Section 4.3)");
  report.text(
      "The paper reports that the linear solver fails when the cloth tangles (Funnel, Twisting, "
      "Sphere) and takes many more iterations elsewhere. Here each solver has one attempt at the "
      "first step of each stretch, of the whole time step and at most 50 rounds.");
  Table table("single_attempts", "One step from the beginning of each stretch",
              {"benchmark", "steps", "solver", "impacts before", "rounds", "iterations",
               "impacts left", "ms impact zones"});

  // What is left is what the last round left, before vertices were put back to their start.
  for (const PaperScene& scene : results.scenes)
    for (const Stretch& stretch : scene.stretches)
      for (const char* solver : {"gradient", "dual", "linear"}) {
        const Json* result = results.find(scene, stretch, std::string("single ") + solver);
        if (!result) continue;
        const Json& rows = result->at("rows");
        const auto impacts = rows.at("impacts").at(0).get<std::vector<double>>();
        table.add({std::string(scene.title), stretch_text(stretch), solver,
                   format_number(impacts.empty() ? 0 : impacts.front(), 9),
                   format_number(sum_of(rows, "rounds")),
                   format_number(sum_of(rows, "zone_iterations"), 9),
                   format_number(impacts.empty() ? 0 : impacts.back(), 9),
                   format_number(sum_of(rows, "ms_impact_zones"))});
      }
  report.add(table);
}

void show_figures(const PaperResults& results, Report& report) {
  const PaperScene *andy = results.scene("andy"), *funnel = results.scene("funnel"),
                   *dress = results.scene("dress");
  if (andy) show_convergence(results, *andy, " a, b", report);
  if (funnel) show_convergence(results, *funnel, " c, d", report);
  if (andy) show_gradient_iterations(results, *andy, report);
  if (dress) show_large_steps(results, *dress, report);
  if (andy) show_incremental(results, *andy, report);
  if (funnel) show_collision_handling(results, *funnel, report);
  if (dress) show_time_steps(results, *dress, report);
  if (andy) show_stages(results, *andy, report);
}

void show_frames(const PaperResults& results, Report& report) {
  if (results.scenes.empty()) return;
  report.heading("Frames that differ from the paper's");
  report.text(
      "The paper's scenes were not published, so that its frames cannot be found again. Ours are "
      "rebuilt from its pictures and its video, and the steps stand for its hard moments.");
  Table table("frames", "Whose steps stand for which frames", {"figure", "paper", "ours"});
  constexpr std::array<std::array<const char*, 3>, 9> kFrames = {
      {{"5 a, b", "Andy, frames 1000–2000", "andy"},
       {"5 c, d", "Funnel, frames 900–1450", "funnel"},
       {"6", "Andy, frames 1000–2000", "andy"},
       {"7", "Dress, a frame that is not named", "dress"},
       {"8", "whole animations, whose lengths are not named", ""},
       {"9", "Andy, a frame of four iterations", "andy"},
       {"10", "Funnel, frames 1000–1400", "funnel"},
       {"11", "Dress, the animation", "dress"},
       {"12", "Andy, the animation", "andy"}}};

  // The steps of a scene in one cell.
  const auto steps_of = [](const PaperScene& scene) {
    std::string text(scene.title);
    for (const Stretch& stretch : scene.stretches) {
      text += &stretch == &scene.stretches.front() ? ", steps " : "; ";
      text += stretch_text(stretch);
    }
    return text;
  };
  for (const auto& [figure, paper, name] : kFrames) {
    std::string ours = *name == '\0' ? "all stretches, and all steps of the runs to them" : "";
    if (const PaperScene* scene = results.scene(name)) ours = steps_of(*scene);
    if (!ours.empty()) table.add({figure, paper, ours});
  }
  report.add(table);
}

}  // namespace icloth
