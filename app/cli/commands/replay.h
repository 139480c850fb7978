// icloth replay: runs recorded input again and compares the state at the end.
#pragma once

#include <string>

namespace icloth {

struct ReplayOptions {
  std::string recording;
  std::string stats_file;      ///< .csv or .json; empty: none
  std::string device;          ///< cpu, cuda or cuda:N; empty: the build that was recorded
  int threads = 0;             ///< of the CPU builds; 0: all
  bool allow_outside = false;  ///< the scene may name files outside its folder
  bool quiet = false;
};

/// Returns 0 when the final state has the recorded hash and every step was accepted, else 1.
/// Throws InputError, and DeviceError when the recorded build has no device here.
int run_replay(const ReplayOptions& options);

}  // namespace icloth
