// One run of a scene, timed and sampled, and its distance from another run.
#pragma once

#include <string>
#include <vector>

#include "sim/simulator.h"

namespace icloth {

/// A scene as it is run for speed against error.
struct TrialScene {
  const char* name;
  int triangles;
  std::vector<std::string> overrides;
  double interval;  ///< between samples [s]
  int samples;
  /// Number of samples whose positions are compared. In later samples folds have formed that depend
  /// on the last digit, so that only energies and areas can be compared.
  int samples_alike;
};

/// The state of the cloths at one time.
struct Sample {
  std::vector<Vec3d> positions, velocities;      ///< of the cloths' vertices
  double kinetic = 0, elastic = 0, gravity = 0;  ///< energies [J]

  double energy() const { return kinetic + elastic + gravity; }
};

/// The outcome of one run.
struct Trial {
  std::vector<Sample> samples;
  std::vector<double> mass;  ///< of the cloths' vertices [kg]
  double seconds = 0;        ///< of wall time a simulated second
  double shadow = 0;         ///< area that the cloths cover from above, mean of the samples [m²]
  double pressed = 0;        ///< deepest intrusion into the thickness: 1 − smallest gap / h
  double violation = 0;      ///< largest of the impact zones, of their offset δ
  double cg_iterations = 0;  ///< of a step
  double solves = 0;         ///< linear systems of a step
  double tests = 0;          ///< elementary tests of a step
  double strain = 0;         ///< largest principal stretch − 1 of any step
  std::size_t penetrations = 0;
  bool finished = false;  ///< no step was refused
};

/// Loads the scene as a trial runs it; `overrides` come after its own.
std::shared_ptr<const Scene> trial_scene(const TrialScene& scene,
                                         const std::vector<std::string>& overrides);

/// Runs the scene once with the overrides. The time step must divide the interval of the samples.
Trial run_trial(const TrialScene& scene, const std::vector<std::string>& overrides, Build build);

/// True when both runs took the same steps to the same end, by the samples and the work of the
/// stages.
bool same_run(const Trial& a, const Trial& b);

/// The distances from a reference. Relative ones refer to the largest of the reference's samples.
struct Errors {
  double position = 0;  ///< root of the mean square over mass and samples [m]; −1: another mesh
  double energy = 0;    ///< largest difference, of what the energies change by
  double momentum = 0;  ///< largest |Σ m (v − v_ref)|, of Σ m |v_ref|
  double shadow = 0;    ///< of the area
};

/// Compares a trial with a reference; `samples_alike` is that of the scene.
Errors compare(const Trial& trial, const Trial& reference, int samples_alike);

/// Marks the points that no other one beats: no point is at most as large in both x and y and
/// smaller in one.
std::vector<bool> pareto_front(const std::vector<std::pair<double, double>>& points);

}  // namespace icloth
