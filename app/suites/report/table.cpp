#include "app/suites/report/table.h"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <cstdlib>

#include "sim/files/text.h"

namespace icloth {
namespace {

bool is_number(const std::string& cell) {
  char* end = nullptr;
  std::strtod(cell.c_str(), &end);
  return !cell.empty() && *end == 0;
}

/// The width of a text in characters, not bytes: continuation bytes of UTF-8 take no room.
std::size_t width(const std::string& cell) {
  return static_cast<std::size_t>(
      std::ranges::count_if(cell, [](char c) { return (c & 0xC0) != 0x80; }));
}

/// A cell in quotes where a comma or a quote would break the line.
std::string csv_cell(const std::string& cell) {
  if (cell.find_first_of(",\"\n") == std::string::npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

}  // namespace

Table::Table(std::string name, std::string title, std::vector<std::string> columns)
    : name_(std::move(name)), title_(std::move(title)), columns_(std::move(columns)) {}

void Table::add(std::vector<std::string> cells) {
  assert(cells.size() == columns_.size());
  rows_.push_back(std::move(cells));
}

std::string Table::text() const {
  // Every column is as wide as its widest cell.
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    widths.push_back(width(columns_[c]));
    for (const auto& row : rows_) widths[c] = std::max(widths[c], width(row[c]));
  }

  // Numbers stand on the right, texts on the left, and lines end without blanks.
  std::string out = title_ + "\n";
  const auto line = [&](const std::vector<std::string>& cells, bool head) {
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::string gap(widths[c] - width(cells[c]), ' ');
      const bool right = is_number(cells[c]) || (head && c > 0);
      out += (c > 0 ? "  " : "") + (right ? gap + cells[c] : cells[c] + gap);
    }
    while (out.back() == ' ') out.pop_back();
    out += '\n';
  };

  line(columns_, true);
  for (const auto& row : rows_) line(row, false);
  return out;
}

std::string Table::csv() const {
  std::string out;
  const auto line = [&](const std::vector<std::string>& cells) {
    for (std::size_t c = 0; c < cells.size(); ++c) out += (c > 0 ? "," : "") + csv_cell(cells[c]);
    out += '\n';
  };
  line(columns_);
  for (const auto& row : rows_) line(row);
  return out;
}

std::string Table::html() const {
  std::string out = "<table><caption>" + markup_text(title_) + "</caption>\n<tr>";
  for (const std::string& column : columns_) out += "<th>" + markup_text(column) + "</th>";
  out += "</tr>\n";
  for (const auto& row : rows_) {
    out += "<tr>";
    for (const std::string& cell : row)
      out += (is_number(cell) ? "<td class=\"n\">" : "<td>") + markup_text(cell) + "</td>";
    out += "</tr>\n";
  }
  return out + "</table>\n";
}

std::string format_number(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

}  // namespace icloth
