// icloth bench compare: this program and another build of it on the same stretches, in turns.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/suites/bench/bench_options.h"

namespace icloth {

/// The rows of a statistics file (CSV) of a run, from step `first` on: values by column, a value a
/// step; and the hash of the last state. Throws InputError.
struct StretchStatistics {
  std::map<std::string, std::vector<double>> values;
  std::string end_hash;

  double sum(const std::string& column) const;
};
StretchStatistics read_stretch(const std::string& csv, const std::string& source, long first);

/// The middle and both ends of some ratios.
struct Spread {
  double median = 0, least = 0, most = 0;
};
Spread spread_of(std::vector<double> ratios);

/// Runs the stretches of the paper's scenes with this program and with `options.other` in turns,
/// `options.repeat` times each, and prints how many times as long the other one takes: machines are
/// noisy, and runs that follow each other see the same noise. Returns 0. Throws InputError,
/// and std::runtime_error where a program fails or leaves penetrations.
int run_compare(const BenchOptions& options);

}  // namespace icloth
