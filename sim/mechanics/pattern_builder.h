// Works out the pattern of the matrix from the elements of all forces.
#pragma once

#include <array>
#include <vector>

#include "sim/mechanics/element_terms.h"

namespace icloth::ICLOTH_BUILD {

/// Stored blocks of a symmetric matrix, row after row, with ascending columns ≥ the row.
struct Pattern {
  std::vector<Index> row_first;  ///< (rows + 1)
  std::vector<Index> column;     ///< (stored blocks)
};

class PatternBuilder {
 public:
  /// Begins another kind of element. `sources` must live until finish(), which writes it.
  void begin_elements(ElementSources& sources) { kinds_.push_back(&sources); }

  /// Couples all vertices of one element of the kind begun last.
  template <class Vertices>
  void add_element(Index element, const Vertices& vertices) {
    constexpr int kCorners = static_cast<int>(std::tuple_size_v<Vertices>);
    for (int a = 0; a < kCorners; ++a)
      for (int b = 0; b < kCorners; ++b)
        add(vertices[static_cast<std::size_t>(a)], vertices[static_cast<std::size_t>(b)],
            ElementBlock<kCorners>::of(element, a, b).number);
  }

  /// The pattern of a matrix with that many rows; writes the sources of all kinds of element.
  Pattern finish(Index rows);

 private:
  /// Block of an element that adds to the stored block (row, column).
  struct Entry {
    Index row, column;
    Index kind;    ///< place in kinds_
    Index source;  ///< ElementBlock::number
    auto operator<=>(const Entry&) const = default;
  };

  /// Keeps blocks on and above the diagonal; the matrix is symmetric.
  void add(Index row, Index column, Index source) {
    if (row <= column)
      entries_.push_back({row, column, static_cast<Index>(kinds_.size()) - 1, source});
  }

  std::vector<Entry> entries_;
  std::vector<ElementSources*> kinds_;
};

}  // namespace icloth::ICLOTH_BUILD
