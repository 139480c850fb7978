#include "sim/linear/matrix_pattern.h"

namespace icloth::ICLOTH_BUILD {

void BlockMatrix::set_pattern(const std::vector<Index>& first, const std::vector<Index>& columns) {
  const std::size_t rows = first.size() - 1;

  // The blocks below the diagonal are those of other rows, transposed. Each row gets a list of
  // them: counted first, then written.
  std::vector<Index> lower(rows + 1, 0);
  const auto for_lower = [&](const auto& visit) {
    for (std::size_t i = 0; i < rows; ++i)
      for (Index k = first[i]; k < first[i + 1]; ++k) {
        const Index j = columns[static_cast<std::size_t>(k)];
        if (j != static_cast<Index>(i)) visit(static_cast<Index>(i), j, k);
      }
  };

  for_lower([&](Index, Index j, Index) { ++lower[static_cast<std::size_t>(j) + 1]; });
  for (std::size_t i = 0; i < rows; ++i) lower[i + 1] += lower[i];

  std::vector<Index> place(lower.begin(), lower.end() - 1);
  std::vector<Index> lower_columns(columns.size() - rows), blocks(columns.size() - rows);
  for_lower([&](Index i, Index j, Index k) {
    const auto slot = static_cast<std::size_t>(place[static_cast<std::size_t>(j)]++);
    lower_columns[slot] = i;
    blocks[slot] = k;
  });

  // All lists go to the device; the numbers get their padding.
  row_first.upload(first);
  column.upload(columns);
  lower_first.upload(lower);
  lower_column.upload(lower_columns);
  lower_block.upload(blocks);
  value.resize(static_cast<Index>(columns.size()) + kPadding);
}

MatrixView BlockMatrix::view() const {
  return {.row_first = row_first.view(),
          .column = column.view(),
          .lower_first = lower_first.view(),
          .lower_column = lower_column.view(),
          .lower_block = lower_block.view(),
          .entries = value.view().data()->m};
}

}  // namespace icloth::ICLOTH_BUILD
