// A table of results: printed, written as CSV, put into a report.
#pragma once

#include <string>
#include <vector>

namespace icloth {

class Table {
 public:
  /// `name`: of its CSV file; `title`: what people read.
  Table(std::string name, std::string title, std::vector<std::string> columns);

  /// As many cells as there are columns.
  void add(std::vector<std::string> cells);

  const std::string& name() const { return name_; }
  const std::string& title() const { return title_; }
  const std::vector<std::string>& columns() const { return columns_; }
  const std::vector<std::vector<std::string>>& rows() const { return rows_; }

  /// Columns aligned with blanks; numbers to the right.
  std::string text() const;
  std::string csv() const;
  std::string html() const;

 private:
  std::string name_, title_;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// "1234", "0.0123", "1.2e-05": so many significant digits.
std::string format_number(double value, int digits = 4);

/// Text with &, < and > made safe.
std::string html_text(const std::string& text);

}  // namespace icloth
