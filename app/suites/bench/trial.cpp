#include "app/suites/bench/trial.h"

#include <algorithm>
#include <cmath>

#include "app/common/headless.h"
#include "app/suites/validation/shadow.h"
#include "app/suites/validation/strips.h"
#include "sim/files/error.h"
#include "sim/scene/scene_io.h"

namespace icloth {
namespace {

/// The area that the cloths cover from above, by squares of 2 mm on the ground about them.
double shadow_of(const Scene& scene, const std::vector<Vec3d>& x) {
  // The ground reaches a square beyond the cloths.
  Vec2d low{1e9, 1e9}, high{-1e9, -1e9};
  for (const Vec3d& p : x) {
    low = {std::min(low.x, p.x), std::min(low.y, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.z)};
  }
  constexpr double kCell = 2e-3;
  validation::Shadow ground({low.x - kCell, low.y - kCell}, {high.x + kCell, high.y + kCell},
                            kCell);

  // The vertices of the cloths follow one another.
  auto first = x.begin();
  for (const Cloth& cloth : scene.cloths) {
    const auto count = static_cast<std::ptrdiff_t>(cloth.mesh.positions.size());
    ground.add({first, first + count}, cloth.mesh.faces);
    first += count;
  }
  return ground.area();
}

/// The state and the energies of the cloths after a step.
Sample sample_of(const Simulator& simulator, std::size_t vertices, const StepReport& report) {
  Snapshot state = simulator.snapshot();
  state.x1.resize(vertices);
  state.v.resize(vertices);
  return {std::move(state.x1), std::move(state.v), report.kinetic_energy, report.elastic_energy,
          report.gravity_energy};
}

/// Runs the job, gathers the statistics of its steps, and keeps a sample every `every` steps.
void run(HeadlessJob& job, long every, int samples, Trial& now) {
  const Parameters& p = job.scene->parameters;
  const std::size_t vertices = now.mass.size();
  double ms = 0;
  job.steps = every * samples;

  // Counts are means over the steps, errors are the worst of all steps.
  job.watch = [&](const Simulator& simulator, const StepReport* report, bool) {
    if (!report) return;
    ms += report->ms_total;
    const double share = 1 / static_cast<double>(job.steps);
    now.cg_iterations += share * static_cast<double>(report->cg_iterations);
    now.solves += share * static_cast<double>(report->linear_solves);
    now.tests += share * static_cast<double>(report->elementary_tests);
    now.pressed = std::max(now.pressed, 1 - report->min_gap / p.proximity.thickness);
    now.strain = std::max(now.strain, report->max_strain);
    now.violation = std::max(now.violation, report->zone_violation / p.impact_zones.offset);
    if (report->step % every == 0) now.samples.push_back(sample_of(simulator, vertices, *report));
  };

  // The time is that of the steps alone, a simulated second.
  const HeadlessResult result = run_headless(job);
  now.penetrations = result.penetrations;
  now.finished = result.refused.empty() && !result.start_refused;
  now.seconds = 1e-3 * ms / (p.step.time_step * static_cast<double>(job.steps));
}

}  // namespace

std::shared_ptr<const Scene> trial_scene(const TrialScene& scene,
                                         const std::vector<std::string>& overrides) {
  std::vector<std::string> all{"triangles=" + std::to_string(scene.triangles)};
  all.insert(all.end(), scene.overrides.begin(), scene.overrides.end());
  all.insert(all.end(), overrides.begin(), overrides.end());
  return load_scene(scene.name, all);
}

Trial run_trial(const TrialScene& scene, const std::vector<std::string>& overrides, Build build) {
  HeadlessJob job;
  job.scene = trial_scene(scene, overrides);
  job.build = build;
  job.quiet = true;

  // Samples are compared at equal times, so they must fall on steps.
  const double per_sample = scene.interval / job.scene->parameters.step.time_step;
  const long every = std::lround(per_sample);
  if (std::fabs(per_sample - static_cast<double>(every)) > 1e-6)
    throw InputError("a time step of " + std::to_string(job.scene->parameters.step.time_step) +
                     " s does not divide the time between samples");

  // The masses weigh the errors of positions and velocities.
  Trial trial;
  for (const Cloth& cloth : job.scene->cloths) {
    const std::vector<double> mass = validation::lumped_mass(cloth);
    trial.mass.insert(trial.mass.end(), mass.begin(), mass.end());
  }

  run(job, every, scene.samples, trial);
  for (const Sample& sample : trial.samples)
    trial.shadow += shadow_of(*job.scene, sample.positions) / scene.samples;
  return trial;
}

bool same_run(const Trial& a, const Trial& b) {
  // Equal samples and equal work of the stages mean that the runs were the same.
  const auto same = [](const Sample& x, const Sample& y) {
    return std::ranges::equal(x.positions, y.positions, [](const Vec3d& p, const Vec3d& q) {
      return p.x == q.x && p.y == q.y && p.z == q.z;
    });
  };
  return a.cg_iterations == b.cg_iterations && a.solves == b.solves && a.tests == b.tests &&
         std::ranges::equal(a.samples, b.samples, same);
}

Errors compare(const Trial& trial, const Trial& reference, int samples_alike) {
  // Another mesh has other vertices: then only energies and areas can be compared.
  Errors errors;
  const std::size_t samples = std::min(trial.samples.size(), reference.samples.size());
  const bool same_mesh = trial.mass.size() == reference.mass.size();
  double squares = 0, mass = 0, energy_change = 0, momentum_size = 0;
  const double start_gravity = reference.samples.empty() ? 0 : reference.samples[0].gravity;

  // Energies and momenta are compared at every sample; the largest difference counts.
  for (std::size_t k = 0; k < samples; ++k) {
    const Sample &a = trial.samples[k], &b = reference.samples[k];
    energy_change =
        std::max(energy_change, b.kinetic + b.elastic + std::fabs(b.gravity - start_gravity));
    errors.energy = std::max(errors.energy, std::fabs(a.energy() - b.energy()));

    Vec3d momentum_error;
    double size = 0;

    // Positions are compared only while both runs still have the same folds.
    for (std::size_t i = 0; same_mesh && i < trial.mass.size(); ++i) {
      const double m = trial.mass[i];
      if (k < static_cast<std::size_t>(samples_alike)) {
        squares += m * norm2(a.positions[i] - b.positions[i]);
        mass += m;
      }
      momentum_error += m * (a.velocities[i] - b.velocities[i]);
      size += m * norm(b.velocities[i]);
    }

    errors.momentum = std::max(errors.momentum, norm(momentum_error));
    momentum_size = std::max(momentum_size, size);
  }

  // Relative errors are of the largest change in the reference.
  errors.position = same_mesh ? std::sqrt(squares / mass) : -1;
  errors.energy /= energy_change;
  errors.momentum = same_mesh ? errors.momentum / momentum_size : -1;
  errors.shadow = std::fabs(trial.shadow / reference.shadow - 1);
  return errors;
}

std::vector<bool> pareto_front(const std::vector<std::pair<double, double>>& points) {
  // A point is off the front when another is at least as good in both and better in one.
  std::vector<bool> front(points.size(), true);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const auto& [x, y] : points) {
      const bool worse = x <= points[i].first && y <= points[i].second &&
                         (x < points[i].first || y < points[i].second);
      if (worse) front[i] = false;
    }
  }
  return front;
}

}  // namespace icloth
