// A table of results: printed, written as CSV, put into a report.
#pragma once

#include <string>
#include <vector>

namespace icloth {

/// Named columns and rows of texts.
class Table {
 public:
  /// `name` is that of its CSV file; `title` is its heading for readers.
  Table(std::string name, std::string title, std::vector<std::string> columns);

  /// Adds a row of as many cells as there are columns.
  void add(std::vector<std::string> cells);

  const std::string& name() const { return name_; }
  const std::string& title() const { return title_; }
  const std::vector<std::string>& columns() const { return columns_; }
  const std::vector<std::vector<std::string>>& rows() const { return rows_; }

  /// The table as text: columns aligned with blanks, numbers to the right.
  std::string text() const;
  std::string csv() const;
  std::string html() const;

 private:
  std::string name_, title_;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// A number with so many significant digits: "1234", "0.0123", "1.2e-05".
std::string format_number(double value, int digits = 4);

}  // namespace icloth
