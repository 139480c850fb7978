// Groups of neighbours in a graph: what the levels of the multilevel preconditioner are made of.
#pragma once

#include <vector>

#include "kernels/parallel/platform.h"

namespace icloth {

/// Undirected graph: neighbours of node i are neighbour[first[i] … first[i + 1] − 1]; no loops.
struct Graph {
  std::vector<Index> first{0}, neighbour;

  Index size() const { return static_cast<Index>(first.size()) - 1; }
};

/// From the upper half of a symmetric pattern, whose diagonal is left out.
Graph graph_of_pattern(const std::vector<Index>& row_first, const std::vector<Index>& column);

struct Aggregation {
  Index count = 0;
  std::vector<Index> group;  ///< of each node, 0 … count − 1
};

/// Connected groups of about `size` nodes, compact: each grows by the node that most of its members
/// know. What is left over in between joins a neighbour, so no group exceeds 1.5 × size. Equal
/// graphs give equal groups.
Aggregation aggregate(const Graph& graph, Index size);

/// The pattern's upper half between the groups, the diagonal first in each row.
void coarse_pattern(const Graph& graph, const Aggregation& groups, std::vector<Index>& row_first,
                    std::vector<Index>& column);

}  // namespace icloth
