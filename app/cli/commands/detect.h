// icloth detect: all collisions between two frames of a mesh.
#pragma once

#include <string>

namespace icloth {

struct DetectOptions {
  std::string start, end;  ///< OBJ or PLY files of one topology
  std::string csv;         ///< prefix of PREFIX_vf.csv and PREFIX_ee.csv; empty: none
  int threads = 0;         ///< 0: all
};

/// Prints counts and times. Returns 0. Throws InputError.
int run_detect(const DetectOptions& options);

}  // namespace icloth
