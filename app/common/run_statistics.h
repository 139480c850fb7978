// Statistics of the steps of a run: the table at its end and the files of --stats.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim/state/report.h"

namespace icloth {

/// Collects the reports of a run.
class RunStatistics {
 public:
  void add(const StepReport& report);
  /// Names the device that computed the steps, and its bandwidth [bytes/s]. It is not called for
  /// the processor.
  void set_device(std::string name, double copy_bandwidth);

  std::size_t steps() const { return reports_.size(); }
  const std::vector<StepReport>& reports() const { return reports_; }
  double median(std::string_view column) const;
  double mean(std::string_view column) const;
  double largest(std::string_view column) const;
  double sum(std::string_view column) const;
  /// Steps a second of the median step; 0 without steps.
  double steps_per_second() const;

  /// The text ', "device": …, "copy_bandwidth": …' for a JSON object; empty for the processor.
  std::string device_json() const;

  /// The table that is printed at the end of a run. `penetrations` is the number of pairs of faces
  /// that intersect in the final state, `state_hash` that state's hash.
  std::string table(std::size_t penetrations, std::uint64_t state_hash) const;

 private:
  std::vector<double> values(std::string_view column) const;

  std::vector<StepReport> reports_;  // without the offending pairs
  std::string device_;
  double copy_bandwidth_ = 0;
};

/// The file of --stats. CSV is written as the run goes, JSON at the end.
class StatisticsFile {
 public:
  /// Opens the file. `path` ends in .csv or .json; empty means that nothing is written. A run that
  /// goes on after `steps` steps keeps the rows of these in a CSV that is there. Throws InputError,
  /// also when the place cannot be written.
  explicit StatisticsFile(std::string path, std::int64_t steps = 0);
  void add(const StepReport& report);
  void finish(const RunStatistics& statistics);

 private:
  std::string path_;
  bool is_csv_ = false;
};

}  // namespace icloth
