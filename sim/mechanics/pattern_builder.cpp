#include "sim/mechanics/pattern_builder.h"

#include <algorithm>

namespace icloth::ICLOTH_BUILD {

Pattern PatternBuilder::finish(Index rows) {
  std::sort(entries_.begin(), entries_.end());
  const std::size_t kinds = kinds_.size();
  std::vector<std::vector<Index>> first(kinds, std::vector<Index>{0}), numbers(kinds);
  Pattern pattern{{0}, {}};

  // Rows without a coupling are closed as empty ones.
  const auto close_rows_before = [&](Index row) {
    while (static_cast<Index>(pattern.row_first.size()) <= row)
      pattern.row_first.push_back(static_cast<Index>(pattern.column.size()));
  };

  // Entries of the same row and column lie side by side and make one stored block.
  for (std::size_t e = 0; e < entries_.size();) {
    const Entry block = entries_[e];
    close_rows_before(block.row);
    pattern.column.push_back(block.column);
    for (;
         e < entries_.size() && entries_[e].row == block.row && entries_[e].column == block.column;
         ++e)
      numbers[static_cast<std::size_t>(entries_[e].kind)].push_back(entries_[e].source);
    for (std::size_t k = 0; k < kinds; ++k)
      first[k].push_back(static_cast<Index>(numbers[k].size()));
  }
  close_rows_before(rows);

  // Each kind of element gets the list of its blocks that add to every stored one.
  for (std::size_t k = 0; k < kinds; ++k) {
    kinds_[k]->first.upload(first[k]);
    kinds_[k]->number.upload(numbers[k]);
  }
  return pattern;
}

}  // namespace icloth::ICLOTH_BUILD
