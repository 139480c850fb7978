#include "app/common/run_statistics.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>

#include "app/common/machine.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace

void RunStatistics::add(const StepReport& report) {
  reports_.push_back(report);
  reports_.back().offending = {};
}

void RunStatistics::set_device(std::string name, double copy_bandwidth) {
  device_ = std::move(name);
  copy_bandwidth_ = copy_bandwidth;
}

std::string RunStatistics::device_json() const {
  if (device_.empty()) return "";
  return ", \"device\": " + nlohmann::json(device_).dump() +
         formatted(", \"copy_bandwidth\": %.4g", copy_bandwidth_);
}

std::vector<double> RunStatistics::values(std::string_view column) const {
  const auto found = std::ranges::find(report_columns(), column, &ReportColumn::name);
  std::vector<double> result;
  if (found == report_columns().end()) return result;
  result.reserve(reports_.size());
  for (const StepReport& report : reports_)
    result.push_back(std::visit([&](auto member) { return static_cast<double>(report.*member); },
                                found->member));
  return result;
}

double RunStatistics::median(std::string_view column) const {
  std::vector<double> sorted = values(column);
  if (sorted.empty()) return 0;
  std::ranges::sort(sorted);
  const std::size_t middle = sorted.size() / 2;
  return sorted.size() % 2 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

double RunStatistics::sum(std::string_view column) const {
  const std::vector<double> all = values(column);
  return std::accumulate(all.begin(), all.end(), 0.0);
}

double RunStatistics::mean(std::string_view column) const {
  return reports_.empty() ? 0 : sum(column) / static_cast<double>(reports_.size());
}

double RunStatistics::largest(std::string_view column) const {
  const std::vector<double> all = values(column);
  return all.empty() ? 0 : *std::ranges::max_element(all);
}

double RunStatistics::steps_per_second() const {
  const double ms = median("ms_total");
  return ms > 0 ? 1000 / ms : 0;
}

std::string RunStatistics::table(std::size_t penetrations, std::uint64_t state_hash) const {
  // Times first, then counts, each with median, mean and largest value.
  std::string text = formatted("%-22s %12s %12s %12s\n", "a step", "median", "mean", "largest");
  for (const char* name : {"ms_total", "ms_proximity", "ms_implicit", "ms_broad_phase", "ms_ccd",
                           "ms_impact_zones", "ms_other"})
    text +=
        formatted("%-22s %12.3f %12.3f %12.3f\n", name, median(name), mean(name), largest(name));
  for (const char* name : {"proximity_pairs", "candidate_pairs", "elementary_tests",
                           "late_contacts", "impacts_first", "rounds", "zones", "cg_iterations"})
    text +=
        formatted("%-22s %12.0f %12.1f %12.0f\n", name, median(name), mean(name), largest(name));

  // The run as a whole.
  text += formatted("%-22s %12zu\n", "steps", steps());
  text += formatted("%-22s %12.2f\n", "steps/s (median)", steps_per_second());
  text += formatted("%-22s %12.0f\n", "impacts resolved", sum("impacts_first"));
  text += formatted("%-22s %12.0f   retries %.0f\n", "substeps", sum("substeps"), sum("retries"));
  if (largest("pinched") > 0) {
    const auto steps_pinched =
        std::ranges::count_if(values("pinched"), [](double n) { return n > 0; });
    text += formatted("%-22s %12.0f   vertices at most, in %lld steps\n", "pinched",
                      largest("pinched"), static_cast<long long>(steps_pinched));
  }

  // The limits that were reached say which settings to look at.
  for (int k = 0; k < kLimitCount; ++k) {
    const auto limit = static_cast<Limit>(k);
    const auto steps_at_limit =
        std::ranges::count_if(reports_, [&](const StepReport& r) { return r.reached(limit); });
    if (steps_at_limit == 0) continue;
    const std::string name(parameter_of(limit));
    text += formatted("%-22s %12lld   steps: %s\n", "limit reached",
                      static_cast<long long>(steps_at_limit), name.c_str());
  }

  // The table ends with the machine and the outcome.
  if (!device_.empty())
    text += formatted("%-22s %12.1f GB/s %s\n", "device", copy_bandwidth_ / 1e9, device_.c_str());
  text += formatted("%-22s %12.1f MB\n", "peak memory", peak_memory_bytes() / 1e6);
  text += formatted("%-22s %12zu\n", "penetrations left", penetrations);
  text += formatted("%-22s %016" PRIx64 "\n", "final state", state_hash);
  return text;
}

namespace {

/// The head of a CSV file and its first rows, one for each step before a run goes on.
std::string kept_rows(const std::string& path, const std::string& head, std::int64_t steps) {
  const std::string text = read_file(path);
  if (!text.starts_with(head))
    throw InputError("--stats " + shown_path(path) +
                     ": has other columns, expected the statistics of the run that is resumed");
  std::size_t end = head.size();
  for (std::int64_t row = 0; row < steps; ++row) {
    const std::size_t next = text.find('\n', end);
    if (next == std::string::npos)
      throw InputError("--stats " + shown_path(path) + ": has " + std::to_string(row) +
                       " rows, expected " + std::to_string(steps) +
                       " or more, those of the run that is resumed");
    end = next + 1;
  }
  return text.substr(0, end);
}

}  // namespace

StatisticsFile::StatisticsFile(std::string path, std::int64_t steps) : path_(std::move(path)) {
  if (path_.empty()) return;

  // A path that cannot work is refused before the run.
  const std::filesystem::path file(path_);
  const bool json = file.extension() == ".json";
  if (!json && file.extension() != ".csv")
    throw InputError("--stats " + shown_path(path_) +
                     ": expected a name that ends in .csv or .json");
  require_folder("--stats", path_);

  // JSON is written whole at the end, which would lose the steps before.
  const bool goes_on = steps > 0 && std::filesystem::exists(file);
  if (json && goes_on)
    throw InputError("--stats " + shown_path(path_) +
                     ": is there already, expected a .csv file or a new name with --resume");
  if (json) return;

  // CSV is opened now and gets its head.
  is_csv_ = true;
  std::string names;
  for (const ReportColumn& column : report_columns())
    names += (names.empty() ? "" : ",") + std::string(column.name);
  names += "\n";
  write_file(path_, goes_on ? kept_rows(path_, names, steps) : names);
}

void StatisticsFile::add(const StepReport& report) {
  if (!is_csv_) return;
  std::string row;
  for (const ReportColumn& column : report_columns())
    row += (row.empty() ? "" : ",") + report_value(report, column);

  // Every row reaches the file at once, so that a crash loses none and a full disk leaves whole
  // ones.
  append_file(path_, row + "\n");
}

void StatisticsFile::finish(const RunStatistics& statistics) {
  // CSV has been written already.
  if (path_.empty() || is_csv_) return;

  // JSON is a list of objects, one a step.
  std::string text = "[";
  for (const StepReport& report : statistics.reports()) {
    text += text.size() > 1 ? ",\n {" : "\n {";
    for (const ReportColumn& column : report_columns()) {
      const bool hash = std::holds_alternative<std::uint64_t StepReport::*>(column.member);

      // Hashes are text, as 64 bits do not fit into a JSON number everywhere.
      const std::string quote = hash ? "\"" : "";
      text += (text.back() == '{' ? "\"" : ", \"") + std::string(column.name) + "\": " + quote +
              report_value(report, column) + quote;
    }
    text += statistics.device_json() + "}";
  }
  write_file(path_, text + "\n]\n");
}

}  // namespace icloth
