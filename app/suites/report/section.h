// A part of a report that is kept as JSON, so that a later run can show it without measuring again.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/suites/report/plot.h"
#include "app/suites/report/table.h"

namespace icloth {

/// A heading with texts, tables and plots, in this order.
struct Section {
  std::string heading;
  std::vector<std::string> texts;
  std::vector<Table> tables;
  std::vector<Plot> plots;
};

nlohmann::ordered_json section_to_json(const Section& section);
/// Throws nlohmann::json::exception where it is not what section_to_json writes.
Section section_from_json(const nlohmann::ordered_json& json);

}  // namespace icloth
