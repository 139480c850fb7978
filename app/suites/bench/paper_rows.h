// The steps of a measurement as columns of numbers, which are kept as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "sim/state/report.h"

namespace icloth {

/// Writes the columns.
class PaperRows {
 public:
  using Json = nlohmann::ordered_json;

  PaperRows();
  /// Goes on with the columns of an earlier run. Throws nlohmann::json::exception.
  explicit PaperRows(Json columns);

  /// `impacts`: keeps the impacts of every round as well.
  void add(const StepReport& report, bool impacts = false);
  /// Appends all rows of others.
  void append(const Json& columns);
  void keep_first(std::size_t rows);

  std::size_t size() const;
  const Json& json() const { return columns_; }

 private:
  Json columns_;
};

/// Reads the columns of a result; throws nlohmann::json::exception where one is missing.
std::vector<double> column_of(const nlohmann::ordered_json& rows, std::string_view name);
/// Sum of the first `count` values of a column, of all where there are fewer.
double sum_of(const nlohmann::ordered_json& rows, std::string_view name, std::size_t count = ~0u);
double largest_of(const nlohmann::ordered_json& rows, std::string_view name);
std::size_t rows_of(const nlohmann::ordered_json& rows);

}  // namespace icloth
