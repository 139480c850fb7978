// The report of a benchmark suite: report.html (self-contained), results.json, a CSV a table.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "app/suites/report/plot.h"
#include "app/suites/report/section.h"
#include "app/suites/report/table.h"

namespace icloth {

/// Collects headings, texts, tables and plots, which it also prints as far as a terminal can show
/// them.
class Report {
 public:
  /// Starts a report with the machine that it was measured on.
  Report(std::string title, nlohmann::ordered_json machine);

  void heading(const std::string& text);
  void text(const std::string& text);
  void add(const Plot& plot);
  /// Prints the table as well.
  void add(const Table& table);
  /// Heading, texts, tables and plots in this order.
  void add(const Section& section);

  /// Writes the files into an existing folder. Throws InputError.
  void write(const std::string& folder) const;

 private:
  std::string title_, body_;
  nlohmann::ordered_json results_;
  std::vector<Table> tables_;
};

}  // namespace icloth
