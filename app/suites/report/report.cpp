#include "app/suites/report/report.h"

#include <cstdio>

#include "sim/files/file_io.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

constexpr const char* kStyle =
    "body{font-family:sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:1em "
    "0;display:block;overflow-x:auto}caption{text-align:left;font-weight:bold;"
    "padding:.3em 0}th,td{border:1px solid #ccc;padding:.2em .6em;text-align:left}"
    "td.n{text-align:right;font-variant-numeric:tabular-nums}svg{max-width:100%;height:auto}";

/// A cell as JSON; numbers stay numbers.
nlohmann::ordered_json json_cell(const std::string& cell) {
  const auto json = nlohmann::ordered_json::parse(cell, nullptr, false);
  return json.is_number() ? json : nlohmann::ordered_json(cell);
}

}  // namespace

Report::Report(std::string title, nlohmann::ordered_json machine) : title_(std::move(title)) {
  results_["suite"] = title_;
  results_["machine"] = machine;
  Table table("machine", "Measured with", {"what", "value"});
  for (const auto& [key, value] : machine.items())
    table.add({key, value.is_string() ? value.get<std::string>() : value.dump()});
  body_ += table.html();
}

void Report::heading(const std::string& text) {
  body_ += "<h2>" + markup_text(text) + "</h2>\n";
  std::printf("\n== %s\n", text.c_str());
}

void Report::text(const std::string& text) {
  body_ += "<p>" + markup_text(text) + "</p>\n";
  std::printf("%s\n", text.c_str());
}

void Report::add(const Plot& plot) { body_ += plot.svg(); }

void Report::add(const Table& table) {
  tables_.push_back(table);
  body_ += table.html();
  std::printf("%s\n", table.text().c_str());
  std::fflush(stdout);
  auto& rows = results_["tables"][table.name()] = nlohmann::ordered_json::array();
  for (const auto& row : table.rows()) {
    nlohmann::ordered_json json;
    for (std::size_t c = 0; c < row.size(); ++c) json[table.columns()[c]] = json_cell(row[c]);
    rows.push_back(json);
  }
}

void Report::add(const Section& section) {
  heading(section.heading);
  for (const std::string& line : section.texts) text(line);
  for (const Table& table : section.tables) add(table);
  for (const Plot& plot : section.plots) add(plot);
}

void Report::write(const std::string& folder) const {
  write_file(folder + "/report.html",
             "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" +
                 markup_text(title_) + "</title><style>" + kStyle + "</style></head><body>\n<h1>" +
                 markup_text(title_) + "</h1>\n" + body_ + "</body></html>\n");
  write_file(folder + "/results.json", results_.dump(1) + "\n");
  for (const Table& table : tables_) write_file(folder + "/" + table.name() + ".csv", table.csv());
}

}  // namespace icloth
