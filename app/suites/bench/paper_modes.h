// The ways in which a stretch of a scene is simulated.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/suites/bench/paper_stretches.h"

namespace icloth {

/// One way, from the state at which the stretch begins.
struct PaperMode {
  std::string name;
  long steps = 0;                             ///< at most
  std::function<void(Parameters&)> change{};  ///< of the scene's own parameters; none: its own
  double cost = 1;                            ///< of a step, in steps of our own, for the time left
  bool impacts = false;                       ///< the impacts of every round are kept
};

inline const std::string kOwnMode = "icloth";

/// All ways for a stretch of a scene; our own is the last, since the run goes on from its end.
std::vector<PaperMode> modes_of(const PaperScene& scene, const Stretch& stretch);

/// Leaves one attempt at the whole step, of at most so many rounds, and nothing to fall back on.
void single_attempt(Parameters& parameters, int rounds);

}  // namespace icloth
