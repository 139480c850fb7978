// The table of Fig. 8 and what belongs to it.
#include <algorithm>
#include <cmath>

#include "app/common/machine.h"
#include "app/suites/bench/paper_figures.h"
#include "app/suites/bench/paper_quiet.h"

namespace icloth {
namespace {

using Json = PaperStore::Json;

constexpr double kMostChange = 0.15;  // of the bandwidth between before and after

/// Sums over stretches of a scene.
struct Sum {
  double steps = 0, ms = 0, collisions = 0;

  void add(const Json& rows, std::size_t count = ~std::size_t{0}) {
    steps += static_cast<double>(std::min(count, rows_of(rows)));
    ms += sum_of(rows, "ms_total", count);
    collisions += collision_ms(rows, count);
  }
  double rate() const { return 1e3 * steps / ms; }
  double collision_seconds() const { return 1e-3 * collisions / steps; }
};

/// What was measured of one way on all stretches of a scene.
struct Speed {
  Sum all;   ///< of its steps
  Sum ours;  ///< the same steps as our own way makes them
  double worst = 0, best = 0;
};

Speed speed_of(const PaperResults& results, const PaperScene& scene, const std::string& mode) {
  Speed speed;
  for (const Stretch& stretch : scene.stretches) {
    const Json* result = results.find(scene, stretch, mode);
    const Json* own = results.find(scene, stretch, kOwnMode);
    if (!result || !own) continue;

    // The worst and the best are stretches as a whole.
    Sum here;
    here.add(result->at("rows"));
    speed.worst = speed.all.steps > 0 ? std::min(speed.worst, here.rate()) : here.rate();
    speed.best = std::max(speed.best, here.rate());
    speed.all.add(result->at("rows"));
    speed.ours.add(own->at("rows"), rows_of(result->at("rows")));
  }
  return speed;
}

/// All steps that the runs of a scene made, between the stretches too.
Sum whole_runs(const PaperResults& results, const PaperScene& scene) {
  Sum sum;
  const Stretch* before = nullptr;
  for (const Stretch& stretch : scene.stretches) {
    const bool same_run = before && before->clip_start == stretch.clip_start;
    before = &stretch;
    const Json* run = results.find_run(scene, stretch);
    if (run && !same_run) sum.add(run->at("rows"));
  }
  return sum;
}

std::string rate_text(const Sum& sum) { return sum.steps > 0 ? format_number(sum.rate(), 3) : "–"; }

std::string ratio_text(double a, double b) {
  return a > 0 && b > 0 ? format_number(a / b, 3) : "–";
}

/// Fig. 8, left: steps a second.
void add_speed_table(const PaperResults& results, Report& report) {
  Table table("fig8_speed", "Fig. 8: steps a second",
              {"benchmark", "triangles", "time step", "CAMA, GTX 1080", "PSCC, GTX 1080",
               "I-Cloth, GTX 1080", "ours, whole run", "ours, worst stretch", "ours, best stretch",
               "CAMA-style, our implementation", "PSCC-style, our implementation",
               "ours / CAMA-style", "ours / PSCC-style"});

  // The paper's figures, ours, and those of the baselines, each as steps a second.
  for (const PaperScene& scene : results.scenes) {
    const Speed own = speed_of(results, scene, kOwnMode);
    const Speed cama = speed_of(results, scene, "cama"), pscc = speed_of(results, scene, "pscc");
    const PublishedSpeed& paper = scene.published;

    table.add({std::string(scene.title), std::to_string(triangles_of(results.context.scale, scene)),
               "1/" + std::to_string(scene.rate), format_number(paper.cama),
               format_number(paper.pscc), format_number(paper.icloth),
               rate_text(whole_runs(results, scene)), format_number(own.worst, 3),
               format_number(own.best, 3), rate_text(cama.all), rate_text(pscc.all),
               ratio_text(cama.all.ms, cama.ours.ms), ratio_text(pscc.all.ms, pscc.ours.ms)});
  }
  report.add(table);
}

/// Fig. 8, right: collision handling; and what the table of the paper does not have.
void add_collision_table(const PaperResults& results, Report& report) {
  Table table("fig8_collisions", "Fig. 8: collision handling, seconds a step",
              {"benchmark", "PSCC, GTX 1080", "I-Cloth, GTX 1080", "PSCC-style, our implementation",
               "ours, same steps", "ratio", "ours, all steps of the stretches", "peak memory [MB]",
               "penetrations", "refused steps"});

  // Memory is the most of any stretch, what went wrong is summed up.
  for (const PaperScene& scene : results.scenes) {
    const Speed pscc = speed_of(results, scene, "pscc"), own = speed_of(results, scene, kOwnMode);
    double memory = 0, penetrations = 0, refused = 0;
    for (const Stretch& stretch : scene.stretches) {
      const Json* result = results.find(scene, stretch, kOwnMode);
      if (!result) continue;
      memory = std::max(memory, result->at("peak_memory").get<double>());
      penetrations += result->at("penetrations").get<double>();
      refused += sum_of(result->at("rows"), "refused");
    }

    const auto seconds = [](const Sum& sum) {
      return sum.steps > 0 ? format_number(sum.collision_seconds(), 3) : "–";
    };
    table.add({std::string(scene.title), format_number(scene.published.pscc_collisions),
               format_number(scene.published.icloth_collisions), seconds(pscc.all),
               seconds(pscc.ours), ratio_text(pscc.all.collisions, pscc.ours.collisions),
               seconds(own.all), format_number(1e-6 * memory, 4), format_number(penetrations),
               format_number(refused)});
  }
  report.add(table);
}

/// Whether nothing else used the cores or the memory during a measurement. `machine`: of its
/// stretch, null where the bandwidth was not measured.
bool was_quiet(const Json& result, const Json* machine) {
  if (result.at("others_share").get<double>() > kMostOthers) return false;
  if (!machine) return true;
  const double before = machine->at("before"), after = machine->at("after");
  return !(std::fabs(after - before) > kMostChange * before);
}

std::string bandwidth_text(const Json* machine, const char* when) {
  const double bandwidth = machine ? machine->at(when).get<double>() : 0;
  return bandwidth > 0 ? format_number(1e-9 * bandwidth, 3) : "–";
}

std::string others_text(const Json& result) {
  const double share = result.at("others_share");
  return share < 0 ? "–" : format_number(share, 2);
}

/// Every stretch and every way, with how the machine was meanwhile.
void add_stretch_table(const PaperResults& results, Report& report) {
  Table table(
      "stretches", "Stretches, from the same checkpoints",
      {"benchmark",     "steps",        "what happens",  "clip starts at [s]", "way",
       "steps made",    "steps/s",      "ms collisions", "substeps",           "retries",
       "late contacts", "impacts",      "rounds",        "zone iterations",    "rolled back",
       "refused",       "penetrations", "max strain",    "share of the cores", "others' share",
       "GB/s before",   "GB/s after",   "quiet",         "start hash"});
  int measured = 0, noisy = 0;

  // A row is one way on one stretch.
  for (const PaperScene& scene : results.scenes) {
    for (const Stretch& stretch : scene.stretches) {
      const Json* machine = results.find(scene, stretch, kMachine);
      for (const PaperMode& mode : modes_of(scene, stretch)) {
        const Json* result = results.find(scene, stretch, mode.name);
        if (!result) continue;
        const Json& rows = result->at("rows");

        // Most columns are means of its steps.
        const auto steps = static_cast<double>(rows_of(rows));
        const auto mean = [&](const char* column) {
          return format_number(sum_of(rows, column) / steps);
        };
        const auto total = [&](const char* column) { return format_number(sum_of(rows, column)); };

        // What should not happen is counted, and so is what the machine did meanwhile.
        ++measured;
        noisy += was_quiet(*result, machine) ? 0 : 1;
        table.add({std::string(scene.title),
                   steps_text(stretch),
                   std::string(stretch.what),
                   stretch.clip_start >= 0 ? format_number(stretch.clip_start) : "–",
                   mode.name,
                   format_number(steps),
                   format_number(1e3 * steps / sum_of(rows, "ms_total"), 3),
                   format_number(collision_ms(rows) / steps),
                   mean("substeps"),
                   total("retries"),
                   mean("late_contacts"),
                   mean("impacts_first"),
                   mean("rounds"),
                   mean("zone_iterations"),
                   total("rolled_back"),
                   total("refused"),
                   format_number(result->at("penetrations").get<double>()),
                   format_number(largest_of(rows, "max_strain"), 3),
                   format_number(result->at("cores_share").get<double>(), 2),
                   others_text(*result),
                   bandwidth_text(machine, "before"),
                   bandwidth_text(machine, "after"),
                   was_quiet(*result, machine) ? "yes" : "no",
                   result->at("start_hash").get<std::string>()});
      }
    }
  }
  report.add(table);

  if (noisy > 0)
    report.text("The machine was not quiet during " + std::to_string(noisy) + " of " +
                std::to_string(measured) +
                " measurements: other programs had a part of the cores or of the memory's "
                "bandwidth, and these speeds are lower than they would be alone.");
  else
    report.text("The machine was quiet during all " + std::to_string(measured) + " measurements.");
}

}  // namespace

const Json* PaperResults::find(const PaperScene& scene_of, const Stretch& stretch,
                               const std::string& mode) const {
  return context.store.find(measurement_name(scene_of, stretch, mode),
                            key_of(context, scene_of, stretch));
}

const Json* PaperResults::find_run(const PaperScene& scene_of, const Stretch& stretch) const {
  return context.store.find(run_name(scene_of, stretch) + "/run",
                            key_of(context, scene_of, stretch));
}

const PaperScene* PaperResults::scene(std::string_view name) const {
  const auto found = std::ranges::find(scenes, name, &PaperScene::name);
  return found == scenes.end() ? nullptr : &*found;
}

double collision_ms(const Json& rows, std::size_t count) {
  return sum_of(rows, "ms_broad_phase", count) + sum_of(rows, "ms_ccd", count) +
         sum_of(rows, "ms_impact_zones", count);
}

void show_speed(const PaperResults& results, Report& report) {
  if (results.scenes.empty()) return;
  report.heading("Speed (Fig. 8)");
  report.text(
      "The paper's figures are means over its whole animations on an NVIDIA GeForce GTX 1080; ours "
      "are of this processor: " +
      processor_name() + ", " + std::to_string(results.context.threads) +
      " threads. Ours differ since a processor has a small part of that GPU's bandwidth, and since "
      "the named stretches are the hard parts of the scenes.");

  // What the baselines are, and how a step goes on that their solver leaves unsolved.
  report.text(
      "CAMA-style and PSCC-style are our implementations (--set mode=cama, --set mode=pscc): all "
      "pairs are tested in every round, with trees or with spatial hashing, and impact zones are "
      "solved by the inelastic projection of Harmon et al. 2008. Both make the first steps of each "
      "stretch from the same checkpoint as our own way, with the same time step, tolerances and "
      "threads; the ratios compare the same steps. Where the linear solver leaves impacts, the "
      "step is cut into substeps as in our own way (column retries), and in the smallest one "
      "vertices that still collide go back to where they started (column rolled back).");
  report.text(
      "Both baselines differ from our own way in rounds and zones, and the PSCC-style also in its "
      "broad phase: on a processor our spatial hashing is slower than our trees, above all where "
      "bodies have other triangles than the cloth. The ratio to the CAMA-style leaves that out.");
  add_speed_table(results, report);
  add_collision_table(results, report);
  add_stretch_table(results, report);
}

bool is_clean(const PaperResults& results) {
  for (const PaperScene& scene : results.scenes)
    for (const Stretch& stretch : scene.stretches)
      if (const Json* result = results.find(scene, stretch, kOwnMode))
        if (result->at("penetrations") != 0 || sum_of(result->at("rows"), "refused") > 0)
          return false;
  return true;
}

}  // namespace icloth
