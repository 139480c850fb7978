// The tables and plots of `icloth bench scaling`.
#pragma once

#include <vector>

#include "app/common/run_statistics.h"
#include "app/suites/bench/scaling_model.h"
#include "app/suites/report/report.h"

namespace icloth {

/// What was measured of one size.
struct ScalingRow {
  MeshCounts mesh;
  double thickness = 0;    ///< of the cloth [m]
  RunStatistics steps;     ///< those that were measured
  double peak_memory = 0;  ///< of the process while it loaded and stepped [bytes]
  double bandwidth = 0;    ///< of the memory, measured with the size [bytes/s]
  std::size_t refused = 0, penetrations = 0;
};

/// Adds times, fitted exponents, floors and memory. Every number is finite: what cannot be measured
/// is a dash.
void report_scaling(const std::vector<ScalingRow>& rows, Report& report);

}  // namespace icloth
