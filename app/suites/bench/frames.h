// States of a run, from which single steps are taken again with other settings.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim/simulator.h"

namespace icloth {

/// Runs a scene without scripted hands with its own parameters, and keeps some of its states.
class Frames {
 public:
  /// Keeps the state before every `every`-th step from `first` to `last`. `watch` is called after
  /// each step, and may throw; without it a line tells how far the run is.
  Frames(Build build, const std::string& scene, const std::vector<std::string>& overrides,
         long first, long last, long every, const std::function<void()>& watch = {});

  const std::vector<Snapshot>& states() const { return states_; }
  /// Reports of all steps of the run.
  const std::vector<StepReport>& reports() const { return reports_; }

  /// Takes one step from a kept state with changed parameters.
  StepReport step(const Snapshot& state, const std::function<void(Parameters&)>& change);
  /// The number of pairs of faces that intersect in the state after the last step.
  std::size_t penetrations() const;

 private:
  std::unique_ptr<Simulator> simulator_;
  Parameters own_;
  std::vector<Snapshot> states_;
  std::vector<StepReport> reports_;
};

}  // namespace icloth
