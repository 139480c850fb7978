// icloth run: headless simulation.
#pragma once

#include <string>
#include <vector>

#include "app/common/options.h"

namespace icloth {

struct RunOptions {
  SimulationOptions simulation;
  std::string out;                   ///< folder of exported frames
  std::vector<std::string> exports;  ///< formats, app/common/frame_formats.h; empty: obj
  long every = 1;                    ///< export each K-th step
  std::string stats_file;            ///< .csv or .json; empty: none
  std::string garments_file;         ///< .csv of how garments are worn; empty: none
  std::string input_file;            ///< recording whose drags are applied; empty: the script
  std::string record_file;           ///< the run is saved here; empty: not
  std::string checkpoint_file;       ///< the state is saved here; empty: not
  long checkpoint_every = 100;       ///< steps
  long check_every = 0;              ///< steps between exact tests of the state; 0: the last only
  std::string resume_file;           ///< checkpoint to go on from; empty: from the start
  std::string on_failure = "stop";   ///< stop or continue
  bool profile = false;              ///< print the time of every primitive
};

/// Simulates, exports, prints the statistics. Returns 0, or 1 when the start state intersects, a
/// step was refused or penetrations are left. Throws InputError, DeviceError.
int run_run(const RunOptions& options);

}  // namespace icloth
