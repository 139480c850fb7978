// The options of `icloth bench`.
#pragma once

#include <string>

namespace icloth {

struct BenchOptions {
  std::string suite = "quick";
  std::string other;   ///< compare: path of another icloth program
  int repeat = 5;      ///< compare: turns of each program
  std::string out;     ///< folder of results.json; empty: none is written
  std::string device;  ///< cpu, cuda or cuda:N; empty: cpu, then cuda where it is usable
  int threads = 0;     ///< of the CPU builds; 0: all
  bool quiet = false;  ///< no progress line
  std::string only;  ///< accuracy, paper, scaling, stability, validation, solver: cases whose name
                     ///< holds this; empty: all
  std::string frames;  ///< stability: folder for OBJ files of some of the states, empty: none
  double scale = 1;    ///< paper, scaling: of the number of triangles
  bool go_on = false;  ///< paper: takes finished measurements from the folder
  double soak = 60;    ///< stability: simulated time of the random dragging [s]
};

}  // namespace icloth
