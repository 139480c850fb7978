#include "app/suites/bench/paper_rows.h"

#include <algorithm>

#include "app/suites/bench/paper_store.h"

namespace icloth {
namespace {

/// The columns of a report that figures need.
constexpr std::string_view kColumns[] = {
    "ms_total",        "ms_proximity",  "ms_implicit",      "ms_broad_phase", "ms_ccd",
    "ms_impact_zones", "substeps",      "retries",          "rounds",         "zone_iterations",
    "late_contacts",   "impacts_first", "elementary_tests", "max_strain"};

double value_of(const StepReport& report, std::string_view name) {
  const auto columns = report_columns();
  const auto column = std::ranges::find(columns, name, &ReportColumn::name);
  return std::visit([&](auto member) { return static_cast<double>(report.*member); },
                    column->member);
}

}  // namespace

PaperRows::PaperRows() : columns_(Json::object()) {
  for (const std::string_view name : kColumns) columns_[std::string(name)] = Json::array();
  for (const char* name : {"box_tests", "refused", "rolled_back", "hash"})
    columns_[name] = Json::array();
}

PaperRows::PaperRows(Json columns) : PaperRows() { append(columns); }

void PaperRows::add(const StepReport& report, bool impacts) {
  for (const std::string_view name : kColumns)
    columns_[std::string(name)].push_back(value_of(report, name));
  columns_["box_tests"].push_back(report.box_tests);

  // A step that zones did not solve in its smallest substep puts vertices back to their start.
  columns_["refused"].push_back(report.accepted ? 0 : 1);
  columns_["rolled_back"].push_back(report.reached(Limit::substep_levels) ? 1 : 0);
  columns_["hash"].push_back(hash_text(report.state_hash));
  if (impacts) columns_["impacts"].push_back(report.impacts_in_rounds);
}

void PaperRows::append(const Json& columns) {
  for (auto& [name, values] : columns_.items())
    for (const Json& value : columns.at(name)) values.push_back(value);
}

void PaperRows::keep_first(std::size_t rows) {
  for (auto& [name, values] : columns_.items())
    values.get_ref<Json::array_t&>().resize(std::min(rows, values.size()));
}

std::size_t PaperRows::size() const { return rows_of(columns_); }

std::vector<double> column_of(const nlohmann::ordered_json& rows, std::string_view name) {
  return rows.at(std::string(name)).get<std::vector<double>>();
}

double sum_of(const nlohmann::ordered_json& rows, std::string_view name, std::size_t count) {
  double sum = 0;
  const std::vector<double> values = column_of(rows, name);
  for (std::size_t k = 0; k < std::min(count, values.size()); ++k) sum += values[k];
  return sum;
}

double largest_of(const nlohmann::ordered_json& rows, std::string_view name) {
  const std::vector<double> values = column_of(rows, name);
  return values.empty() ? 0 : *std::ranges::max_element(values);
}

std::size_t rows_of(const nlohmann::ordered_json& rows) { return rows.at("hash").size(); }

}  // namespace icloth
